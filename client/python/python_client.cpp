#include "client/python/python_client.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <thread>

namespace liloc::client::python {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kSignalCheck = std::chrono::milliseconds(50);  // so that Ctrl-C ends a wait; by hand
constexpr double kLongestWaitS = 1e6;                         // more would overflow the clock

constexpr std::size_t kStampsKept = 64;  // who waits asks by the newest pose that it took; by hand

thread_local int callbacks_deep = 0;

/// Calls with the GIL. What it raises goes to sys.unraisablehook: the client's thread has nobody to raise to.
template <class... Values>
void call(const Callback& callback, const char* what, const Values&... values) {
  if (!callback) return;
  const py::gil_scoped_acquire gil;
  ++callbacks_deep;
  try {
    (*callback)(values...);
  } catch (py::error_already_set& error) {
    error.discard_as_unraisable(what);
  }
  --callbacks_deep;
}

std::vector<std::weak_ptr<PythonClient>>& living() {  // touched with the GIL alone
  static std::vector<std::weak_ptr<PythonClient>> clients;
  return clients;
}

}  // namespace

Callback callback_of(const py::object& callable, const char* what) {
  if (callable.is_none()) return {};
  if (PyCallable_Check(callable.ptr()) == 0)
    throw py::type_error(std::string(what) + " must be callable or None");
  return Callback(new py::object(callable), [](py::object* last) {
    const py::gil_scoped_acquire gil;
    delete last;
  });
}

void set_python_log(const py::object& callable) {
  static Callback current;
  Callback next = callback_of(callable, "the log's callback");
  const Callback previous =
      std::exchange(current, next);  // dropped after the change, outside the log's own lock
  const py::gil_scoped_release unlocked;
  if (!next) return set_log({});
  set_log([next](int level, const std::string& line) { call(next, "liloc log callback", level, line); });
}

struct PythonClient::Feed {
  Callback on_pose, on_reply;
  std::mutex mutex;
  std::condition_variable fresh;
  PoseUpdate newest;
  std::deque<std::int64_t> stamps_ns, stamps_before_ns;  ///< of the newest frames, and of those before the
                                                         ///< clock was set back

  void take(const PoseUpdate& update) {
    {
      const std::scoped_lock lock(mutex);
      if (update.stamp_ns < newest.stamp_ns) stamps_before_ns = std::exchange(stamps_ns, {});
      stamps_ns.push_back(update.stamp_ns);
      if (stamps_ns.size() > kStampsKept) stamps_ns.pop_front();
      newest = update;
    }
    fresh.notify_all();
    call(on_pose, "liloc on_pose callback", update);
  }
  /// With the lock.
  [[nodiscard]] bool newer_than(std::int64_t stamp_ns) const {
    return newest.stamp_ns > stamp_ns ||
           std::find(stamps_before_ns.begin(), stamps_before_ns.end(), stamp_ns) != stamps_before_ns.end();
  }
};

PythonClient::PythonClient(const Options& options, Callback on_pose, Callback on_reply)
    : feed_(std::make_shared<Feed>()) {
  feed_->on_pose = std::move(on_pose);
  feed_->on_reply = std::move(on_reply);
  const py::gil_scoped_release unlocked;
  auto made = Client::create(
      options, [feed = feed_](const PoseUpdate& update) { feed->take(update); },
      [feed = feed_](const Reply& reply) { call(feed->on_reply, "liloc on_reply callback", reply); });
  if (made)
    client_ = std::move(made.value());
  else if (made.error().rfind("options.", 0) == 0)
    throw py::value_error(made.error());
  else
    throw ClientError(made.error());
}

PythonClient::~PythonClient() {
  if (callbacks_deep > 0) {  // a callback dropped the last reference: its own thread cannot wait for itself
    std::thread([client = std::move(client_)]() mutable { client.reset(); }).detach();
    return;
  }
  const py::gil_scoped_release unlocked;
  client_.reset();
}

void PythonClient::check(const Outcome<Taken>& pushed) const {
  if (pushed) return;
  if (stopped_) throw ClientError(pushed.error());
  throw py::value_error(pushed.error());
}

void PythonClient::push_depth(const py::object& depth, std::int64_t stamp_ns) {
  const DepthArray image = depth_of(depth);
  const int height = static_cast<int>(std::min<py::ssize_t>(image.shape(0), INT32_MAX));
  const int width = static_cast<int>(std::min<py::ssize_t>(image.shape(1), INT32_MAX));
  Outcome<Taken> pushed = Taken{};
  {
    const py::gil_scoped_release unlocked;
    pushed = client_->push_depth(image.data(), width, height, stamp_ns);
  }
  check(pushed);
}

void PythonClient::push_imu(const py::object& stamps_ns, const py::object& samples) {
  const std::vector<Imu> imu = imu_of(stamps_ns, samples);
  Outcome<Taken> pushed = Taken{};
  {
    const py::gil_scoped_release unlocked;
    for (const Imu& one : imu) {  // one that is refused does not take the others along
      auto taken = client_->push_imu(one.stamp_ns, one.angular_velocity_rad_s, one.specific_force_m_s2);
      if (pushed && !taken) pushed = std::move(taken);
    }
  }
  check(pushed);
}

void PythonClient::push_points(const py::object& points, std::int64_t stamp_ns) {
  const PointArray xyz = points_of(points);
  Outcome<Taken> pushed = Taken{};
  {
    const py::gil_scoped_release unlocked;
    pushed = client_->push_points(xyz.data(), static_cast<std::size_t>(xyz.shape(0)), stamp_ns);
  }
  check(pushed);
}

void PythonClient::push_odometry(std::int64_t stamp_ns, const py::object& T_odom_base,
                                 const py::object& covariance) {
  const Pose T = from_matrix(T_odom_base, "T_odom_base");
  const auto known = covariance_of(covariance);
  Outcome<Taken> pushed = Taken{};
  {
    const py::gil_scoped_release unlocked;
    pushed = client_->push_odometry(stamp_ns, T, known);
  }
  check(pushed);
}

PoseUpdate PythonClient::newest() const {
  const py::gil_scoped_release unlocked;
  return client_->newest();
}

Stats PythonClient::stats() const {
  const py::gil_scoped_release unlocked;
  return client_->stats();
}

std::optional<PoseUpdate> PythonClient::wait(std::int64_t stamp_ns, double timeout_s) {
  if (!(timeout_s >= 0)) throw py::value_error("timeout_s must be 0 or more");
  const std::shared_ptr<Feed> feed = feed_;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(std::min(timeout_s, kLongestWaitS)));
  const auto newer = [&] { return feed->newer_than(stamp_ns); };
  while (true) {
    {
      const py::gil_scoped_release unlocked;
      std::unique_lock lock(feed->mutex);
      if (feed->fresh.wait_until(lock, std::min(end, Clock::now() + kSignalCheck), newer)) return feed->newest;
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (Clock::now() >= end) return {};
  }
}

void PythonClient::stop() {
  if (callbacks_deep > 0) throw ClientError("stop() inside a callback; call it from another thread");
  Outcome<Taken> stopped = Taken{};
  {
    const py::gil_scoped_release unlocked;
    const std::scoped_lock lock(stopping_);
    stopped = client_->stop();
    stopped_ = true;
  }
  feed_->on_pose.reset();  // no callback runs any more; a callback that holds the client would keep it for ever
  feed_->on_reply.reset();
  if (!stopped) throw ClientError(stopped.error());
}

void stop_at_exit(const std::shared_ptr<PythonClient>& client) {
  auto& clients = living();
  clients.erase(std::remove_if(clients.begin(), clients.end(), [](const auto& c) { return c.expired(); }),
                clients.end());
  clients.push_back(client);
}

void stop_all() {
  const auto clients = std::move(living());
  living().clear();
  for (const auto& known : clients)
    if (const auto client = known.lock()) {
      try {
        client->stop();
      } catch (const ClientError& error) {
        PySys_WriteStderr("liloc: %.900s\n", error.what());
      }
    }
  set_python_log(py::none());
}

}  // namespace liloc::client::python
