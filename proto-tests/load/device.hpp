#pragma once
// One simulated device: its own DDS participant, its client's schedule and clock, requests from the script.
#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

#include "client/engine/request_schedule.hpp"
#include "client/session/session_clock.hpp"
#include "common/wire/spots/client_link.hpp"
#include "proto-tests/load/outcome.hpp"
#include "proto-tests/load/plan.hpp"
#include "proto-tests/load/script.hpp"
#include "proto-tests/sim/base/random.hpp"

namespace liloc::load {

/// When a run started, by this machine's clocks, and what of it is measured.
struct RunClock {
  std::chrono::steady_clock::time_point start;
  StampNs start_ns = 0;  ///< the same moment, wall clock
  double from_s = 0, to_s = 0;
  double ceiling_from_s = 0;  ///< when the site began to move, before the run's start

  /// What the site's clock would show, had it not gone to and fro; never under 0.
  [[nodiscard]] double site_s(double at_s) const { return std::max(0.0, at_s - ceiling_from_s); }

  [[nodiscard]] std::chrono::steady_clock::time_point at(double s) const {
    return start + std::chrono::nanoseconds(from_seconds(s));
  }
  [[nodiscard]] double now_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
};

class Device {
 public:
  /// `script` and `options` must outlive it.
  Device(const Script& script, const LoadOptions& options, const RunClock& clock, DevicePlan plan);

  [[nodiscard]] const DevicePlan& plan() const { return plan_; }
  /// Joins and leaves the domain. Not from the thread that ticks: it takes milliseconds.
  [[nodiscard]] Status join(const wire::DomainOptions& seat);
  void leave();
  /// A frame at its planned time; sends what it makes due. One thread.
  void tick(double planned_s);
  /// After `leave`.
  void add_to(Outcomes* outcomes);

 private:
  struct Seat {  // in the order in which they are made
    wire::Participant participant;
    std::unique_ptr<wire::Dispatcher> dispatcher;
    std::unique_ptr<wire::ClientLink> link;
  };
  struct Asked {
    RequestRow row;
    Pose T_map_sensor;  ///< the truth
  };
  void meet_fate(double planned_s);
  [[nodiscard]] const ScriptFrame& frame_at(double planned_s) const;
  [[nodiscard]] SpotRequest request_of(const ScriptFrame& frame, StampNs stamp_ns);
  [[nodiscard]] std::optional<SpotRequest> frame_came(double planned_s);
  void take_reply(const SpotReply& reply);
  void note_available(double planned_s, double now_s);

  const Script& script_;
  const LoadOptions& options_;
  const RunClock clock_;
  const DevicePlan plan_;
  SessionClock device_clock_;
  std::mutex seat_mutex_;
  std::shared_ptr<Seat> seat_;

  std::mutex mutex_;  // guards what follows: of the thread that ticks, and of replies
  sim::Random random_;
  RequestSchedule schedule_;
  std::size_t path_, next_kidnap_ = 0;
  Pose T_odom_script_ = Pose::Identity();  ///< the script's odometry in this device's
  std::uint32_t segment_ = 1;
  std::vector<LocalPose> poses_;  ///< since the last request
  double motion_variance_rad2_ = 0, motion_variance_m2_ = 0;
  StampNs newest_ns_ = 0;
  std::vector<Asked> asked_;  ///< by seq, from 1
  DeviceRow row_;
  double available_until_s_ = 0, lost_since_s_ = -1;
};

}  // namespace liloc::load
