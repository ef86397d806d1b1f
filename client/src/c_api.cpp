// The C API on top of the C++ one: checks what C cannot, keeps the order of calls, lets no exception out.
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <new>

#include "client/src/c_api_structs.hpp"

using namespace liloc;
using namespace liloc::client;

struct liloc_client {
  Options options;
  liloc_pose_callback on_pose = nullptr;
  void* pose_user = nullptr;
  liloc_reply_callback on_reply = nullptr;
  void* reply_user = nullptr;

  std::mutex mutex;  ///< start, stop and the callbacks' registration
  std::unique_ptr<Client> owned;
  std::atomic<Client*> running = nullptr;  ///< `owned`, once it started; stays after stop
  std::atomic<bool> stopped = false;
};

namespace {

thread_local std::string last_error;
thread_local int callbacks_deep = 0;

liloc_status refuse(liloc_status status, std::string text) {
  last_error = std::move(text);
  return status;
}

/// Runs the call; whatever is thrown inside becomes a status.
template <class Call>
liloc_status guarded(Call&& call) noexcept {
  try {
    return call();
  } catch (const std::bad_alloc&) {
    last_error.clear();
    last_error.append("out of memory");  // short enough to need none
    return LILOC_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    return refuse(LILOC_INTERNAL, error.what());
  } catch (...) {
    return refuse(LILOC_INTERNAL, "an exception without a text");
  }
}

liloc_status taken(const Status& status) {
  return status ? LILOC_OK : refuse(LILOC_INVALID_ARGUMENT, status.error().message);
}

liloc_status refuse_null(const char* what) {
  return refuse(LILOC_INVALID_ARGUMENT, fmt::format("{} is NULL", what));
}

liloc_status refuse_no_client() {
  return refuse(LILOC_INVALID_ARGUMENT, "client is NULL; pass what liloc_client_create gave");
}

liloc_status refuse_stopped(const liloc_client& client) {
  return refuse(LILOC_WRONG_STATE, client.options.id + ": stopped; create another client");
}

/// A callback that stops its own client would wait for itself.
liloc_status refuse_in_callback(const char* call) {
  return refuse(LILOC_WRONG_STATE, fmt::format("{} inside a callback; call it from another thread", call));
}

liloc_status not_started(const liloc_client& client) {
  return refuse(LILOC_WRONG_STATE, client.options.id + ": not started; call liloc_client_start first");
}

/// Counts how deep this thread is in callbacks.
struct InCallback {
  InCallback() { ++callbacks_deep; }
  ~InCallback() { --callbacks_deep; }
  InCallback(const InCallback&) = delete;
  InCallback& operator=(const InCallback&) = delete;
};

PoseCallback pose_callback(const liloc_client& client) {
  if (client.on_pose == nullptr) return {};
  return [call = client.on_pose, user = client.pose_user](const PoseUpdate& update) {
    const InCallback inside;
    const liloc_pose_update u = c_api::to_c(update);
    call(&u, user);
  };
}

ReplyCallback reply_callback(const liloc_client& client) {
  if (client.on_reply == nullptr) return {};
  return [call = client.on_reply, user = client.reply_user](const Reply& reply) {
    const InCallback inside;
    const liloc_reply r = c_api::to_c(reply);
    call(&r, user);
  };
}

/// Errors of the options name them; all else came from outside.
liloc_status refuse_start(const std::string& error) {
  return refuse(error.starts_with("options.") ? LILOC_INVALID_ARGUMENT : LILOC_FAILED, error);
}

liloc_status start(liloc_client& client) {
  const std::scoped_lock lock(client.mutex);
  if (client.stopped) return refuse_stopped(client);
  if (client.owned) return refuse(LILOC_WRONG_STATE, client.options.id + ": already started");
  auto made = Client::create(client.options, pose_callback(client), reply_callback(client));
  if (!made) return refuse_start(made.error());
  client.owned = std::move(made.value());
  client.running = client.owned.get();
  return LILOC_OK;
}

liloc_status stop(liloc_client& client) {
  const std::scoped_lock lock(client.mutex);
  if (client.stopped.exchange(true) || !client.owned) return LILOC_OK;
  const auto stopped = client.owned->stop();
  return stopped ? LILOC_OK : refuse(LILOC_FAILED, stopped.error());
}

template <class Set>
liloc_status set_callback(liloc_client* client, Set&& set) {
  if (client == nullptr) return refuse_no_client();
  const std::scoped_lock lock(client->mutex);
  if (client->stopped) return refuse_stopped(*client);
  if (client->owned)
    return refuse(LILOC_WRONG_STATE, client->options.id + ": started; set callbacks before liloc_client_start");
  set();
  return LILOC_OK;
}

/// Hands a sample to the running client.
template <class Push>
liloc_status push(liloc_client& client, Push&& push_to) {
  Client* running = client.running;
  if (client.stopped) return refuse_stopped(client);
  if (running == nullptr) return not_started(client);
  const auto pushed = push_to(*running);
  if (pushed) return LILOC_OK;
  return client.stopped ? refuse_stopped(client) : refuse(LILOC_INVALID_ARGUMENT, pushed.error());
}

bool finite(const double* three) {
  return std::isfinite(three[0]) && std::isfinite(three[1]) && std::isfinite(three[2]);
}

}  // namespace

const char* liloc_client_version(void) {
  return LILOC_VERSION;
}

const char* liloc_client_last_error(void) {
  return last_error.c_str();
}

const char* liloc_client_status_name(int status) {
  static constexpr const char* kNames[] = {"LILOC_OK",     "LILOC_INVALID_ARGUMENT", "LILOC_WRONG_STATE",
                                           "LILOC_FAILED", "LILOC_OUT_OF_MEMORY",    "LILOC_INTERNAL"};
  return status >= LILOC_OK && status <= LILOC_INTERNAL ? kNames[status] : "unknown status";
}

liloc_status liloc_client_set_log(liloc_log_callback callback, void* user) {
  return guarded([&] {
    if (callback == nullptr)
      set_log({});
    else
      set_log([callback, user](int level, const std::string& line) { callback(level, line.c_str(), user); });
    return LILOC_OK;
  });
}

liloc_status liloc_client_options_init(liloc_client_options* options, size_t size) {
  return guarded(
      [&] { return taken(c_api::copy_out(c_api::default_options(), options, size, "liloc_client_options")); });
}

liloc_status liloc_client_create(const liloc_client_options* options, size_t size, liloc_client** client) {
  return guarded([&] {
    if (client == nullptr) return refuse_null("client (where the handle goes)");
    *client = nullptr;
    auto own = c_api::options_from(options, size);
    if (!own) return refuse(LILOC_INVALID_ARGUMENT, own.error().message);
    auto made = std::make_unique<liloc_client>();
    made->options = std::move(*own);
    *client = made.release();
    return LILOC_OK;
  });
}

liloc_status liloc_client_on_pose(liloc_client* client, liloc_pose_callback callback, void* user) {
  return guarded([&] {
    return set_callback(client, [&] {
      client->on_pose = callback;
      client->pose_user = user;
    });
  });
}

liloc_status liloc_client_on_reply(liloc_client* client, liloc_reply_callback callback, void* user) {
  return guarded([&] {
    return set_callback(client, [&] {
      client->on_reply = callback;
      client->reply_user = user;
    });
  });
}

liloc_status liloc_client_start(liloc_client* client) {
  return guarded([&] {
    if (client == nullptr) return refuse_no_client();
    if (callbacks_deep > 0) return refuse_in_callback("liloc_client_start");
    return start(*client);
  });
}

liloc_status liloc_client_push_depth(liloc_client* client, const uint16_t* units, int32_t width, int32_t height,
                                     int64_t stamp_ns) {
  return guarded([&] {
    if (client == nullptr) return refuse_no_client();
    if (units == nullptr) return refuse_null("units");
    return push(*client, [&](Client& to) { return to.push_depth(units, width, height, stamp_ns); });
  });
}

liloc_status liloc_client_push_imu(liloc_client* client, int64_t stamp_ns, const double* angular_velocity_rad_s,
                                   const double* specific_force_m_s2) {
  return guarded([&] {
    const double *w = angular_velocity_rad_s, *a = specific_force_m_s2;
    if (client == nullptr) return refuse_no_client();
    if (w == nullptr) return refuse_null("angular_velocity_rad_s");
    if (a == nullptr) return refuse_null("specific_force_m_s2");
    if (!finite(w) || !finite(a))
      return refuse(LILOC_INVALID_ARGUMENT, client->options.id + ": IMU sample is not finite; leave it out");
    if (!client->options.T_imu_sensor)
      return refuse(LILOC_INVALID_ARGUMENT, client->options.id + ": IMU sample from a client without an IMU; " +
                                                "set options.has_imu and options.T_imu_sensor");
    return push(*client, [&](Client& to) {
      return to.push_imu(stamp_ns, {w[0], w[1], w[2]}, {a[0], a[1], a[2]});
    });
  });
}

liloc_status liloc_client_push_points(liloc_client* client, const float* xyz, size_t count, int64_t stamp_ns) {
  return guarded([&] {
    if (client == nullptr) return refuse_no_client();
    if (xyz == nullptr) return refuse_null("xyz");
    return push(*client, [&](Client& to) { return to.push_points(xyz, count, stamp_ns); });
  });
}

liloc_status liloc_client_push_odometry(liloc_client* client, int64_t stamp_ns, const liloc_pose* T_odom_base,
                                        const double* covariance) {
  return guarded([&] {
    if (client == nullptr) return refuse_no_client();
    if (T_odom_base == nullptr) return refuse_null("T_odom_base");
    std::optional<std::array<double, 36>> known;
    if (covariance != nullptr) std::copy_n(covariance, known.emplace().size(), known->begin());
    return push(*client,
                [&](Client& to) { return to.push_odometry(stamp_ns, c_api::from_c(*T_odom_base), known); });
  });
}

liloc_status liloc_client_newest(const liloc_client* client, liloc_pose_update* update, size_t size) {
  return guarded([&] {
    if (client == nullptr) return refuse_no_client();
    const Client* running = client->running;
    if (running == nullptr) return not_started(*client);
    return taken(c_api::copy_out(c_api::to_c(running->newest()), update, size, "liloc_pose_update"));
  });
}

liloc_status liloc_client_stats(const liloc_client* client, liloc_stats* stats, size_t size) {
  return guarded([&] {
    if (client == nullptr) return refuse_no_client();
    const Client* running = client->running;
    if (running == nullptr) return not_started(*client);
    return taken(c_api::copy_out(c_api::to_c(running->stats()), stats, size, "liloc_stats"));
  });
}

liloc_status liloc_client_stop(liloc_client* client) {
  return guarded([&] {
    if (client == nullptr) return refuse_no_client();
    if (callbacks_deep > 0) return refuse_in_callback("liloc_client_stop");
    return stop(*client);
  });
}

liloc_status liloc_client_destroy(liloc_client* client) {
  return guarded([&] {
    if (client == nullptr) return LILOC_OK;
    if (callbacks_deep > 0) return refuse_in_callback("liloc_client_destroy");
    const liloc_status stopped = stop(*client);
    delete client;
    return stopped;
  });
}
