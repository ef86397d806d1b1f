#pragma once
#include <filesystem>
#include <mutex>
#include <optional>

#include "client/engine/engine.hpp"
#include "client/engine/trace.hpp"
#include "client/session/frame_budget.hpp"
#include "client/session/sample_inbox.hpp"
#include "client/session/session_clock.hpp"
#include "client/session/session_report.hpp"

namespace liloc {

/// An image, or a cloud in its place.
struct SensorFrame {
  DepthImage image;  ///< its stamp alone, of a cloud
  bool is_cloud = false;
  Cloud points_sensor;
  SessionClock::Time arrived{};
};

/// The engine at work on one thread, while replies come in on others: takes the samples that came before each
/// frame, keeps to its share of a core, reports and writes the trace.
class LocalRegistration {
 public:
  /// What a frame came to, and the request that it made due.
  struct Registered {
    FrameResult frame;
    Tracking tracking = Tracking::searching;
    std::optional<SpotRequest> request;
  };

  /// `cpu_share` of one core. The others outlive it.
  LocalRegistration(const EngineOptions& options, double cpu_share, SampleInbox& samples, SessionClock& clock,
                    SessionReport& report);

  /// Before the first frame. Errors: the folder.
  [[nodiscard]] Status open_trace(const std::filesystem::path& folder);
  /// Idempotent. Errors: what could not be written.
  [[nodiscard]] Status close_trace();

  /// By one thread. The clouds of a request travel as `codec`. Empty for a frame that is left out or refused,
  /// which is reported.
  [[nodiscard]] std::optional<Registered> add(const SensorFrame& input, CloudCodec codec);
  /// From any thread; waits at most for the frame in work.
  void add_reply(const SpotReply& reply);
  /// The same.
  void server_found();

 private:
  [[nodiscard]] bool skips(StampNs stamp_ns);
  [[nodiscard]] std::optional<Registered> add_locked(const SensorFrame& input, CloudCodec codec);
  void hand_over_samples();
  [[nodiscard]] Result<FrameResult> measured(const SensorFrame& input);
  void keep_time(const SensorFrame& input, bool set_back);
  [[nodiscard]] std::optional<SpotRequest> take_request();

  const std::string client_id_;
  const bool external_;  ///< odometry comes from outside
  SampleInbox& samples_;
  SessionClock& clock_;
  SessionReport& report_;

  std::mutex mutex_;  ///< held for one frame or one reply; guards the next two
  Engine engine_;
  std::optional<TraceWriter> trace_;

  FrameBudget budget_;     ///< of the thread that adds frames, as is what follows
  bool skipping_ = false;  ///< some frame was left out
  LineLimit clock_lines_;
};

}  // namespace liloc
