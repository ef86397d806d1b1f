// The C API on top of the C++ one: checks what C cannot, keeps the order of calls, lets no exception out.
#include <cmath>
#include <memory>

#include "client/api/c_api_handle.hpp"
#include "common/base/log.hpp"

using namespace liloc;
using namespace liloc::client;
using namespace liloc::client::c_api;

namespace {

liloc_status taken(const Status& status) {
  return status ? LILOC_OK : refuse(LILOC_INVALID_ARGUMENT, status.error().message);
}

template <class Set>
liloc_status set_callback(liloc_client* client, Set&& set) {
  if (client == nullptr) return refuse_no_client();
  const auto refuse_started = [&] {
    return refuse(LILOC_WRONG_STATE, client->options.id + ": started; set callbacks before liloc_client_start");
  };
  if (client->running != nullptr)
    return refuse_started();  // without the lock, which a stop holds while it waits
  const std::scoped_lock lock(client->mutex);
  if (client->stopped) return refuse_stopped(*client);
  if (client->owned) return refuse_started();
  set();
  return LILOC_OK;
}

/// Hands a sample to the running client.
template <class Push>
liloc_status push(liloc_client& client, Push&& push_to) {
  Client* running = client.running;
  if (client.stopped) return refuse_stopped(client);
  if (running == nullptr) return refuse_not_started(client);
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
  return last_error().c_str();
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
      set_log([callback, user](int level, const std::string& line) {
        const InCallback inside;
        callback(level, line.c_str(), user);
      });
    return LILOC_OK;
  });
}

liloc_status liloc_client_options_init(liloc_client_options* options, size_t size) {
  return guarded([&] { return taken(copy_out(default_options(), options, size, "liloc_client_options")); });
}

liloc_status liloc_client_create(const liloc_client_options* options, size_t size, liloc_client** client) {
  return guarded([&] {
    if (client == nullptr) return refuse_null("client (where the handle goes)");
    *client = nullptr;
    auto own = options_from(options, size);
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
    if (in_callback()) return refuse_in_callback("liloc_client_start");
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
    return push(*client, [&](Client& to) { return to.push_odometry(stamp_ns, from_c(*T_odom_base), known); });
  });
}

liloc_status liloc_client_newest(const liloc_client* client, liloc_pose_update* update, size_t size) {
  return guarded([&] {
    if (client == nullptr) return refuse_no_client();
    const Client* running = client->running;
    if (running == nullptr) return refuse_not_started(*client);
    return taken(copy_out(to_c(running->newest()), update, size, "liloc_pose_update"));
  });
}

liloc_status liloc_client_stats(const liloc_client* client, liloc_stats* stats, size_t size) {
  return guarded([&] {
    if (client == nullptr) return refuse_no_client();
    const Client* running = client->running;
    if (running == nullptr) return refuse_not_started(*client);
    return taken(copy_out(to_c(running->stats()), stats, size, "liloc_stats"));
  });
}

liloc_status liloc_client_stop(liloc_client* client) {
  return guarded([&] {
    if (client == nullptr) return refuse_no_client();
    if (in_callback()) return refuse_in_callback("liloc_client_stop");
    return stop(*client);
  });
}

liloc_status liloc_client_destroy(liloc_client* client) {
  return guarded([&] {
    if (client == nullptr) return LILOC_OK;
    if (in_callback()) return refuse_in_callback("liloc_client_destroy");
    if (stop(*client) != LILOC_OK) liloc::log::error("{}", last_error());
    delete client;
    return LILOC_OK;
  });
}
