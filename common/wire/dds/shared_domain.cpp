#include "common/wire/dds/shared_domain.hpp"

#include <dds/dds.h>

#include <map>
#include <mutex>

namespace liloc::wire {
namespace {

struct Domains {
  std::mutex mutex;
  std::map<int, std::weak_ptr<Entity>> by_id;
};

Domains& domains() {
  static Domains all;
  return all;
}

}  // namespace

Result<std::shared_ptr<Entity>> shared_domain(const DomainOptions& options) {
  const std::scoped_lock lock(domains().mutex);
  auto& known = domains().by_id[options.domain];
  if (auto domain = known.lock()) return domain;
  const auto xml = profile_xml(options);
  if (!xml) return tl::unexpected(xml.error());
  auto entity = checked(dds_create_domain(static_cast<dds_domainid_t>(options.domain), xml->c_str()),
                        fmt::format("domain {} on interface {}", options.domain, options.interface));
  if (!entity) return tl::unexpected(entity.error());
  auto domain = std::make_shared<Entity>(std::move(*entity));
  known = domain;
  return domain;
}

bool domain_is_held(int domain) {
  const std::scoped_lock lock(domains().mutex);
  const auto known = domains().by_id.find(domain);
  return known != domains().by_id.end() && !known->second.expired();
}

}  // namespace liloc::wire
