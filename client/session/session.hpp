#pragma once
// The engine on its threads, without a transport: requests leave through a function, replies come in by a call.
#include <filesystem>
#include <functional>
#include <memory>

#include "client/session/session_report.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct SessionOptions {
  EngineOptions engine;
  std::size_t queue_frames = 4;
  std::filesystem::path trace_folder;  ///< empty: no trace
  double cpu_share = 1;                ///< of one core for the registration; frames are left out to keep it
};

struct SessionCallbacks {
  /// Sends a request; on the sending thread, may wait. An error counts as unsent.
  std::function<Status(const SpotRequest&)> send;
  /// After each frame; on the registration thread.
  std::function<void(const FrameResult&, Tracking)> on_frame;
};

/// All calls are safe from any thread; none waits for the network.
class Session {
 public:
  /// Errors: the trace folder.
  [[nodiscard]] static Result<std::unique_ptr<Session>> create(SessionOptions options,
                                                               SessionCallbacks callbacks);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Queues; the oldest frame makes room when the queue is full. Errors: stopped, a stamp that is not positive
  /// or looks like another unit.
  [[nodiscard]] Status push_depth(DepthImage image);
  /// A cloud in place of an image; the same queue. Errors: as above.
  [[nodiscard]] Status push_points(StampNs stamp_ns, Cloud cloud_sensor);
  /// A frame came that cannot be used: counted, told, and the problem until the next one is taken; nothing once
  /// stopped.
  void refuse_frame(const std::string& why);
  /// Handed to the engine before the next frame, which waits a moment for it. Errors: the local method is not
  /// external, stopped, the stamp as above.
  [[nodiscard]] Status push_odometry(const OdometrySample& sample);
  /// Handed to the engine before the next frame. Errors: no IMU in the options, not finite, stopped, the
  /// stamp as above.
  [[nodiscard]] Status push_imu(const ImuSample& sample);
  /// What a server says it reads; requests from the next frame on travel as something that it does
  /// (CodecChoice).
  void add_server(const std::string& server_id, const std::vector<CloudCodec>& reads);
  /// Waits at most for the frame in work. False where another server's answers count (ServerChoice), and for
  /// one that no request of this session asked for.
  bool add_reply(const SpotReply& reply);
  /// To be called often, as each 20 ms: another server's reply that counts by now, because the followed one is
  /// late with the same request. It was added; waits as `add_reply` does.
  std::optional<SpotReply> add_overdue_reply();
  /// Requests have been unanswered for a while, whichever server is asked: each may be gone, and started anew.
  [[nodiscard]] bool unanswered() const;
  /// A server was found: what was asked before may have gone nowhere, so the next frame asks.
  void server_found();
  /// One that could not be understood: counted, and told once in five seconds.
  void reply_dropped(const std::string& why);
  /// Another device was seen to ask under this id: told as a problem for ten seconds.
  void namesake_heard();

  [[nodiscard]] std::optional<FrameResult> newest_frame() const;
  [[nodiscard]] Tracking tracking() const;
  [[nodiscard]] SessionStats stats() const;
  /// Refuses new frames, finishes the waiting ones, sends what is due, closes the trace. Idempotent.
  [[nodiscard]] Status stop();

 private:
  struct Impl;
  explicit Session(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc
