#pragma once
// From a request and the room to an answer: propose, judge, verify. No I/O.
#include <cstdint>
#include <memory>
#include <string>

#include "common/protocol/spot.hpp"
#include "server/global_cloud/global_cloud.hpp"

namespace liloc {

/// The paper's variants (section 7): `liloc` is everything, the others leave parts out for comparison.
enum class Method { liloc, dynamic_noopt, dynamic_nover, static_noopt };
[[nodiscard]] Result<Method> method_from(std::string_view name);

struct LocalizerOptions {
  Method method = Method::liloc;
  double voxel_size_m = 0.05;
  double sampling = 0.5;   ///< share of points with features that RANSAC uses (paper, section 5.2)
  std::uint64_t seed = 1;  ///< all randomness comes from it, the client id and the request's seq
  int threads = 1;         ///< per request
  std::string server_id = "liloc";
};

/// Thread-safe: workers call `locate` side by side; requests of one client are answered in turn.
class Localizer {
 public:
  Localizer(GlobalCloud& global_cloud, LocalizerOptions options);
  ~Localizer();
  Localizer(const Localizer&) = delete;
  Localizer& operator=(const Localizer&) = delete;

  /// Never throws, always answers. Blocks for as long as the search takes.
  [[nodiscard]] SpotReply locate(const SpotRequest& request);
  /// Forgets what is known of a client, e.g. when it has left.
  void forget(const std::string& client_id);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc
