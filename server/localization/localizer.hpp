#pragma once
// From a request and the room to an answer: propose, judge, verify. No I/O.
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/protocol/spot.hpp"
#include "common/registration/search/cell_bounds.hpp"
#include "common/registration/search/gravity_search.hpp"
#include "server/global_cloud/global_cloud.hpp"
#include "server/localization/following.hpp"

namespace liloc {

/// How a spot is searched. `liloc` is everything; `paper` is the paper's way (sections 5.2 and 5.3), and the
/// others are its baselines (section 7), which leave parts of that out.
enum class Method { liloc, paper, dynamic_noopt, dynamic_nover, static_noopt };
[[nodiscard]] Result<Method> method_from(std::string_view name);

/// What makes an answer a verified one: tracks over the last spots, the paper's three checks, or nothing.
enum class Verify { tracks, paper, none };
[[nodiscard]] Result<Verify> verify_from(std::string_view name);

/// What the last refinement minimizes: distances between points, as in the paper, or along normals.
enum class Icp { point, plane };
[[nodiscard]] Result<Icp> icp_from(std::string_view name);

/// Defaults are by hand where nothing else is said.
struct LocalizerOptions {
  Method method = Method::liloc;
  std::optional<Verify> verify = std::nullopt;  ///< empty: the method's own
  std::optional<Icp> icp = std::nullopt;        ///< empty: the method's own
  double voxel_size_m = 0.05;                   ///< paper, section 3.1.5; 0.03 and 0.08 m are in VARIANTS.md
  double sampling = 0.5;   ///< share of points with features that RANSAC uses (paper, section 5.2)
  std::uint64_t seed = 1;  ///< all randomness comes from it, the client id and the request's seq
  int threads = 1;         ///< per request
  std::string server_id = "liloc";
  double risk = 1e-3;  ///< of all verified answers, the share that may be wrong, 1e-6..0.1
  /// A search of the room may take so long, then the request is refused: what was not searched may look like
  /// what was. Without a limit answers do not depend on load.
  std::chrono::steady_clock::duration search_limit = GravitySearchOptions{}.time_limit;
  /// Whether there is time for work that nobody waits for, asked by a worker; empty: always.
  std::function<bool()> idle = {};
  Describer describer = {};  ///< of points, for the searches by features; empty: FPFH

  [[nodiscard]] Verify verify_or_default() const;
  [[nodiscard]] Icp icp_or_default() const;
  /// Errors: a combination that cannot work; names the options.
  [[nodiscard]] Status validated() const;
};

/// The global cloud that a localizer of these options works on: the paper's was raw, people included.
[[nodiscard]] GlobalCloudOptions global_cloud_options_for(const LocalizerOptions& options);

struct Answered;
/// Takes an answer with all that it rests on. Called by the thread that calls `locate`, before it returns.
using AnswerSink = std::function<void(Answered)>;

/// Thread-safe: workers call `locate` side by side; requests of one client are answered in turn.
class Localizer {
 public:
  /// `learned`: the bounds that an earlier run left. `sink`, unless empty, is given each answer that met a
  /// room.
  Localizer(GlobalCloud& global_cloud, LocalizerOptions options, CellBounds learned = {}, AnswerSink sink = {});
  ~Localizer();
  Localizer(const Localizer&) = delete;
  Localizer& operator=(const Localizer&) = delete;

  /// Never throws, always answers. Blocks for as long as the search takes.
  [[nodiscard]] SpotReply locate(const SpotRequest& request);
  /// Forgets what is known of a client, e.g. when it has left.
  void forget(const std::string& client_id);
  /// What another server or run could go on with; none while the client is searched. Waits for the client's
  /// request in work.
  [[nodiscard]] std::optional<Remembered> remembered(const std::string& client_id) const;
  /// Goes on with what was remembered so many seconds ago, in place of a search of the room: the next spot
  /// judges it as any other. To be called for the same run of the client alone: where it was forgotten less
  /// than a minute ago its session goes on as it was.
  void resume(const std::string& client_id, const Remembered& remembered, double age_s);
  /// Forgets all clients; what verified answers have taught stays.
  void forget_all();
  /// What verified answers have taught so far. A new object whenever there was something to learn.
  [[nodiscard]] std::shared_ptr<const CellBounds> learned() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc
