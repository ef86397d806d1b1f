// What the methods of LocalizerOptions are called and what they stand for.
#include <algorithm>
#include <array>

#include "server/localization/localizer.hpp"

namespace liloc {
namespace {

template <class Value, std::size_t count>
Result<Value> named(std::string_view what, std::string_view name,
                    const std::array<std::pair<std::string_view, Value>, count>& known) {
  std::string names;
  for (const auto& [known_name, value] : known) {
    if (known_name == name) return value;
    names += (names.empty() ? "" : ", ") + std::string(known_name);
  }
  return fail("{} '{}' is unknown; choose one of {}", what, name, names);
}

}  // namespace

Result<Method> method_from(std::string_view name) {
  return named<Method, 5>("method", name,
                          {{{"liloc", Method::liloc},
                            {"paper", Method::paper},
                            {"dynamic-noopt", Method::dynamic_noopt},
                            {"dynamic-nover", Method::dynamic_nover},
                            {"static-noopt", Method::static_noopt}}});
}

Result<Verify> verify_from(std::string_view name) {
  return named<Verify, 3>("verify", name,
                          {{{"tracks", Verify::tracks}, {"paper", Verify::paper}, {"none", Verify::none}}});
}

Result<Icp> icp_from(std::string_view name) {
  return named<Icp, 2>("icp", name, {{{"point", Icp::point}, {"plane", Icp::plane}}});
}

Verify LocalizerOptions::verify_or_default() const {
  if (verify) return *verify;
  if (method == Method::liloc) return Verify::tracks;
  return method == Method::dynamic_nover ? Verify::none : Verify::paper;
}

Icp LocalizerOptions::icp_or_default() const {
  return icp ? *icp : method == Method::liloc ? Icp::plane : Icp::point;
}

Status LocalizerOptions::validated() const {
  if (!(risk >= 1e-6 && risk <= 0.1)) return fail("risk is {}; give 0.000001 to 0.1", risk);
  if (method != Method::liloc && verify_or_default() == Verify::tracks)
    return fail("verify tracks needs the free-space search of method liloc; choose verify paper or none");
  return {};
}

GlobalCloudOptions global_cloud_options_for(const LocalizerOptions& options) {
  GlobalCloudOptions cloud;
  cloud.snapshot.voxel_size_m = options.voxel_size_m;
  cloud.snapshot.feature_sampling = options.sampling;
  cloud.snapshot.describer = options.describer;
  cloud.drop_moving = options.method == Method::liloc;
  return cloud;
}

}  // namespace liloc
