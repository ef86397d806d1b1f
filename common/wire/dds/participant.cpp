#include "common/wire/dds/participant.hpp"

#include <dds/dds.h>

#include <cstdlib>

#include "common/wire/dds/entity.hpp"
#include "common/wire/dds/log_sink.hpp"
#include "common/wire/dds/security.hpp"
#include "common/wire/dds/shared_domain.hpp"

namespace liloc::wire {
namespace {

bool profile_of_user() {
  const char* uri = std::getenv("CYCLONEDDS_URI");
  return uri != nullptr && *uri != '\0';
}

}  // namespace

struct Participant::Impl {
  int domain_id = 0;
  std::shared_ptr<Entity> domain;  // before the participant: it goes last
  Entity participant;
};

Result<Participant> Participant::create(const DomainOptions& options) {
  install_log_sink();
  Qos qos = make_qos();
  if (!options.credentials.empty()) {
    auto secured = security_qos(options.credentials);
    if (!secured) return tl::unexpected(secured.error());
    qos = std::move(*secured);
  }
  auto impl = std::make_shared<Impl>();
  impl->domain_id = options.domain;
  if (!profile_of_user()) {
    auto domain = shared_domain(options);
    if (!domain) return tl::unexpected(domain.error());
    impl->domain = std::move(*domain);
  }
  auto participant =
      checked(dds_create_participant(static_cast<dds_domainid_t>(options.domain), qos.get(), nullptr),
              fmt::format("participant in domain {} on interface {}{}", options.domain, options.interface,
                          options.credentials.empty() ? "" : " with credentials " + options.credentials));
  if (!participant) return tl::unexpected(participant.error());
  impl->participant = std::move(*participant);
  return Participant(std::move(impl));
}

std::int32_t Participant::handle() const {
  return impl_->participant.handle();
}
int Participant::domain() const {
  return impl_->domain_id;
}

}  // namespace liloc::wire
