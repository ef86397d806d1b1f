#include "proto-tests/load/device.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/log.hpp"

namespace liloc::load {
namespace {

constexpr std::size_t kMostPoses = 250;                     // of a request; the message holds 256
constexpr double kWrong_m = 0.3, kWrong_rad = radians(10);  // off by more, an answer is wrong
// The lag of a request that its own participant, not yet in the domain, kept from leaving: a timeout of a
// client.
constexpr double kNotJoined_ms = 4000;
constexpr std::uint64_t kReplyBytes = 1000;  // a reply has no sequence: all are about as long

RequestScheduleOptions schedule_of(const LoadOptions& options) {
  RequestScheduleOptions schedule;
  schedule.interval_ns = from_ms(options.interval_ms);
  return schedule;
}

Outcome outcome_of(const SpotReply& reply) {
  if (reply.verified()) return Outcome::verified;
  if (reply.status == SpotStatus::provisional) return Outcome::provisional;
  return reply.reason == Reason::superseded ? Outcome::superseded : Outcome::refused;
}

std::uint64_t bytes_of(const SpotRequest& request) {
  constexpr std::uint64_t kFixed = 400, kPose = 72;  // of the message, as idl/liloc.idl lays it out
  return kFixed + request.lpc.bytes.size() + request.extra.bytes.size() + kPose * request.local_poses.size();
}

}  // namespace

Device::Device(const Script& script, const LoadOptions& options, const RunClock& clock, DevicePlan plan)
    : script_(script),
      options_(options),
      clock_(clock),
      plan_(std::move(plan)),
      random_(plan_.seed, 1),
      schedule_(schedule_of(options)),
      path_(plan_.path) {}

Status Device::join(const wire::DomainOptions& domain) {
  auto participant = wire::Participant::create(domain);
  if (!participant) return tl::unexpected(participant.error());
  auto dispatcher = wire::Dispatcher::create(*participant);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  wire::ClientCallbacks callbacks;
  callbacks.on_reply = [this](const SpotReply& reply) { take_reply(reply); };
  callbacks.on_bad_reply = [this](const std::string& why) { log::warning("{}: {}", plan_.id, why); };
  auto link = wire::ClientLink::create(**dispatcher, plan_.id, std::move(callbacks));
  if (!link) return tl::unexpected(link.error());
  (*dispatcher)->start();
  const std::scoped_lock lock(seat_mutex_);
  seat_ = std::make_shared<Seat>(Seat{std::move(*participant), std::move(*dispatcher), std::move(*link)});
  return {};
}

void Device::leave() {
  std::shared_ptr<Seat> seat;
  {
    const std::scoped_lock lock(seat_mutex_);
    seat = std::move(seat_);
  }
}

const ScriptFrame& Device::frame_at(double planned_s) const {
  const Path& path = script_.paths[path_];
  const double at_s = to_and_fro(clock_.site_s(planned_s), script_.seconds);
  return path[std::min(static_cast<std::size_t>(std::lround(at_s / kFrame_s)), path.size() - 1)];
}

/// Odometry breaks and is noticed; a device is carried elsewhere and its odometry notices nothing.
void Device::meet_fate(double planned_s) {
  if (planned_s >= plan_.lost_at_s && lost_since_s_ < 0 && row_.recovered_s < 0) {
    ++segment_;
    poses_.clear();
    schedule_.search_begins();
    lost_since_s_ = planned_s;
    row_.recovered_s = std::numeric_limits<double>::infinity();
  }
  if (next_kidnap_ >= plan_.kidnaps_s.size() || planned_s < plan_.kidnaps_s[next_kidnap_]) return;
  ++next_kidnap_;
  const Pose T_odom_sensor = T_odom_script_ * frame_at(planned_s).T_odom_sensor;
  path_ = static_cast<std::size_t>(random_.below(static_cast<int>(script_.paths.size())));
  T_odom_script_ = T_odom_sensor * frame_at(planned_s).T_odom_sensor.inverse();
}

SpotRequest Device::request_of(const ScriptFrame& frame, StampNs stamp_ns) {
  SpotRequest request = *frame.request;
  request.client_id = plan_.id;
  request.seq = asked_.size() + 1;
  request.stamp_ns = stamp_ns;
  request.odom_segment = segment_;
  request.T_odom_sensor = T_odom_script_ * frame.T_odom_sensor;
  request.odom_sd_rad = std::sqrt(motion_variance_rad2_);
  request.odom_sd_m = std::sqrt(motion_variance_m2_);
  request.local_poses = std::exchange(poses_, {});
  motion_variance_rad2_ = motion_variance_m2_ = 0;
  return request;
}

std::optional<SpotRequest> Device::frame_came(double planned_s) {
  const std::scoped_lock lock(mutex_);
  meet_fate(planned_s);
  if (random_.chance(options_.frame_loss)) return std::nullopt;
  const ScriptFrame& frame = frame_at(planned_s);
  newest_ns_ = clock_.start_ns + from_seconds(planned_s + plan_.clock_offset_s);
  device_clock_.frame(newest_ns_, std::chrono::steady_clock::now());
  if (poses_.size() < kMostPoses)
    poses_.push_back({newest_ns_, T_odom_script_ * frame.T_odom_sensor, frame.informative});
  if (frame.request) {
    motion_variance_rad2_ += frame.request->odom_sd_rad * frame.request->odom_sd_rad;
    motion_variance_m2_ += frame.request->odom_sd_m * frame.request->odom_sd_m;
  }
  static_cast<void>(schedule_.take_unanswered(newest_ns_));  // counted by what came in the end
  if (!schedule_.due(newest_ns_, frame.request.has_value())) return std::nullopt;
  SpotRequest request = request_of(frame, newest_ns_);
  Asked& asked = asked_.emplace_back();
  asked.row.planned_s = planned_s;
  asked.row.of_lost = lost_since_s_ >= 0;
  asked.T_map_sensor = frame.T_map_sensor;
  schedule_.sent(request.seq, newest_ns_);
  return request;
}

void Device::tick(double planned_s) {
  auto request = frame_came(planned_s);
  if (!request) return;
  std::shared_ptr<Seat> seat;
  {
    const std::scoped_lock lock(seat_mutex_);
    seat = seat_;
  }
  device_clock_.stamp(*request, std::chrono::steady_clock::now());
  const Status sent = seat ? seat->link->send(*request) : Status(fail("not in the domain yet"));
  const double left_s = clock_.now_s();
  const std::scoped_lock lock(mutex_);
  RequestRow& row = asked_[request->seq - 1].row;
  row.lag_ms = seat ? 1e3 * (left_s - planned_s) : kNotJoined_ms;
  if (!sent) return log::debug("{}: {}", plan_.id, sent.error().message);
  if (row.outcome == Outcome::unsent) row.outcome = Outcome::unanswered;  // its reply may have been quicker
  row_.sent_bytes += bytes_of(*request);
}

void Device::note_available(double planned_s, double now_s) {
  const double until_s = std::min({planned_s + 2e-3 * options_.interval_ms, clock_.to_s, plan_.end_s});
  const double from_s = std::max({now_s, available_until_s_, clock_.from_s});
  row_.available_s += std::max(0.0, until_s - from_s);
  available_until_s_ = std::max(available_until_s_, until_s);
}

void Device::take_reply(const SpotReply& reply) {
  device_clock_.learn(reply, std::chrono::steady_clock::now());
  const double now_s = clock_.now_s();
  const std::scoped_lock lock(mutex_);
  if (reply.seq < 1 || reply.seq > asked_.size()) return;
  Asked& asked = asked_[reply.seq - 1];
  if (asked.row.outcome > Outcome::unanswered) return;  // answered already
  asked.row.outcome = outcome_of(reply);
  asked.row.latency_ms = 1e3 * (now_s - asked.row.planned_s);
  row_.received_bytes += kReplyBytes;
  schedule_.answered(reply, newest_ns_);
  if (!reply.verified() || !reply.T_map_sensor) return;
  asked.row.wrong = distance_m(*reply.T_map_sensor, asked.T_map_sensor) > kWrong_m ||
                    angle_between_rad(*reply.T_map_sensor, asked.T_map_sensor) > kWrong_rad;
  if (reply.odom_segment != segment_) return;
  schedule_.search_ended();
  note_available(asked.row.planned_s, now_s);
  if (lost_since_s_ >= 0) row_.recovered_s = now_s - std::exchange(lost_since_s_, -1);
}

void Device::add_to(Outcomes* outcomes) {
  const std::scoped_lock lock(mutex_);
  for (const Asked& asked : asked_)
    if (asked.row.planned_s >= clock_.from_s) outcomes->requests.push_back(asked.row);
  row_.present_s = std::max(0.0, std::min(plan_.end_s, clock_.to_s) - std::max(plan_.start_s, clock_.from_s));
  outcomes->devices.push_back(row_);
}

}  // namespace liloc::load
