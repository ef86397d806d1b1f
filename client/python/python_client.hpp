#pragma once
// liloc.Client: the C++ client with Python's lock handled. Two rules keep it free of deadlock: whoever waits
// has released the GIL, and a callback takes it anew on the client's thread.
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

#include "client/python/arrays.hpp"

namespace liloc::client::python {

/// What is wrong lies outside the call's arguments; liloc.Error in Python.
struct ClientError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A callable that any thread may drop; empty for None.
using Callback = std::shared_ptr<py::object>;
/// Raises TypeError when it is neither None nor callable; `what` names it.
[[nodiscard]] Callback callback_of(const py::object& callable, const char* what);

/// Where the log goes; None: nowhere. Process-wide.
void set_python_log(const py::object& callable);

/// All calls come with the GIL held.
class PythonClient {
 public:
  /// Joins the network. Raises ValueError for an option, liloc.Error for the rest.
  PythonClient(const Options& options, Callback on_pose, Callback on_reply);
  ~PythonClient();
  PythonClient(const PythonClient&) = delete;
  PythonClient& operator=(const PythonClient&) = delete;

  void push_depth(const py::object& depth, std::int64_t stamp_ns);
  void push_imu(const py::object& stamps_ns, const py::object& samples);
  void push_points(const py::object& points, std::int64_t stamp_ns);
  void push_odometry(std::int64_t stamp_ns, const py::object& T_odom_base, const py::object& covariance);
  [[nodiscard]] PoseUpdate newest() const;
  [[nodiscard]] Stats stats() const;
  /// Waits for a frame newer than `stamp_ns`; empty when none was processed in time. Ctrl-C ends the wait.
  [[nodiscard]] std::optional<PoseUpdate> wait(std::int64_t stamp_ns, double timeout_s);
  /// Raises liloc.Error for the trace's error, and inside a callback.
  void stop();

 private:
  struct Feed;
  void check(const Outcome<Taken>& pushed) const;

  std::shared_ptr<Feed> feed_;  ///< shared with the client's threads
  std::unique_ptr<Client> client_;
  std::mutex stopping_;  ///< a second stop waits for the first
  std::atomic<bool> stopped_ = false;
};

/// At the end of the interpreter all clients stop: a callback could not take the GIL any more.
void stop_at_exit(const std::shared_ptr<PythonClient>& client);
void stop_all();

}  // namespace liloc::client::python
