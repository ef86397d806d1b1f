#include "proto-tests/faults/players.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "client/include/liloc/client.hpp"
#include "proto-tests/load/forked.hpp"
#include "proto-tests/replay/processes.hpp"
#include "proto-tests/replay/streams.hpp"
#include "proto-tests/replay/timeline.hpp"
#include "proto-tests/replay/truth.hpp"

namespace liloc::faults {
namespace {

using replay::Event;

constexpr double kLate_s = 0.2;                    // no sensor sends what is older; by hand
constexpr double kAfter_s = 1.5;                   // for the last replies; by hand
constexpr double kWrong_m = 0.3, kWrong_deg = 10;  // as everywhere: proto-tests/replay/evaluation.hpp

std::vector<Event> events_of(const Performance& performance, bool of_ceiling) {
  std::vector<Event> all = replay::timeline(performance.recording);
  const StampNs first_ns = all.front().due_ns;
  std::erase_if(all, [&](const Event& event) {
    const bool is_ceiling = event.kind == Event::Kind::ceiling;
    return is_ceiling != of_ceiling || (!is_ceiling && event.source != 0) ||
           to_seconds(event.due_ns - first_ns) > performance.seconds;
  });
  return all;
}

StampNs first_of(const Recording& recording) {
  return replay::timeline(recording).front().due_ns;
}

/// Waits until an event is due; false for one that is too late by now.
bool await(const Performance& performance, double due_s) {
  std::this_thread::sleep_until(performance.start + std::chrono::nanoseconds(from_seconds(due_s)));
  return performance.now_s() - due_s < kLate_s;
}

StampNs stepped(StampNs stamp_ns, double at_s, double step_s, double step_at_s) {
  return at_s >= step_at_s ? stamp_ns + from_seconds(step_s) : stamp_ns;
}

client::Options client_options(const Performance& performance, const wire::DomainOptions& seat) {
  const DeviceInfo& info = performance.recording.devices.front().info;
  client::Options options;
  options.id = info.id;
  const Camera& c = info.camera;
  options.camera = {c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.depth_scale_m};
  options.domain = seat.domain;
  options.network_interface = seat.interface;
  options.peers = seat.peers;
  options.still_seconds = info.still_seconds;
  if (info.T_imu_sensor) {
    const Eigen::Vector3d t = info.T_imu_sensor->translation();
    const Eigen::Quaterniond q(info.T_imu_sensor->linear());
    options.T_imu_sensor = client::Pose{{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}};
  }
  return options;
}

Pose to_pose(const client::Pose& pose) {
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(pose.translation_m.data());
  T.linear() = Eigen::Quaterniond(Eigen::Vector4d(pose.rotation_xyzw.data())).normalized().toRotationMatrix();
  return T;
}

/// Holds what the device is told against the truth. Replies and frames come on a thread each.
class Judge {
 public:
  Judge(const Performance& performance, replay::Truth truth)
      : performance_(performance), truth_(std::move(truth)) {
    const StampNs first_ns = first_of(performance.recording);
    const auto& depth = performance.recording.devices.front().depth;
    for (std::size_t i = 0; i < depth.size() && i < truth_.size(); ++i) {
      const double at_s = to_seconds(depth[i].stamp_ns - first_ns);
      frames_[stepped(depth[i].stamp_ns, at_s, performance.faults.device_step_s,
                      performance.faults.step_at_s)] = {at_s, i};
    }
  }

  void reply(const client::Reply& reply) {
    const auto frame = frames_.find(reply.stamp_ns);
    if (frame == frames_.end()) return;
    ReplyRow row{performance_.now_s(), frame->second.at_s, reply.verified, false};
    if (reply.verified && reply.T_map_sensor)
      row.wrong = is_wrong(to_pose(*reply.T_map_sensor), frame->second.index);
    story.replies.push_back(row);
  }

  void frame(const client::PoseUpdate& update) {
    const auto frame = frames_.find(update.stamp_ns);
    if (frame == frames_.end()) return;
    FrameRow row{frame->second.at_s, update.T_map_sensor.has_value(), update.state == client::State::lost, 0,
                 0};
    if (update.T_map_sensor) {
      const Pose T_map_sensor = to_pose(*update.T_map_sensor);
      row.error_m = distance_m(truth_.pose(frame->second.index), T_map_sensor);
      row.error_deg = degrees(angle_between_rad(truth_.pose(frame->second.index), T_map_sensor));
    }
    story.frames.push_back(row);
  }

  DeviceStory story;

 private:
  struct Taken {
    double at_s = 0;
    std::size_t index = 0;
  };
  [[nodiscard]] bool is_wrong(const Pose& T_map_sensor, std::size_t index) const {
    return distance_m(truth_.pose(index), T_map_sensor) > kWrong_m ||
           degrees(angle_between_rad(truth_.pose(index), T_map_sensor)) > kWrong_deg;
  }

  const Performance& performance_;
  const replay::Truth truth_;
  std::map<StampNs, Taken> frames_;  ///< by the stamp that the device gives them
};

/// What cannot be pushed is the client's to count.
void push(client::Client& device, const Performance& performance, const Event& event, StampNs stamp_ns,
          const DepthImage* image) {
  if (image != nullptr) {
    (void)device.push_depth(image->units.data(), image->width, image->height, stamp_ns);
    return;
  }
  const ImuSample& sample = performance.recording.devices[event.source].imu[event.index];
  const auto& w = sample.angular_velocity_rad_s;
  const auto& f = sample.specific_force_m_s2;
  (void)device.push_imu(stamp_ns, {w.x(), w.y(), w.z()}, {f.x(), f.y(), f.z()});
}

void push_all(client::Client& device, const Performance& performance) {
  const auto events = events_of(performance, false);
  const StampNs first_ns = first_of(performance.recording);
  const StreamFaults& faults = performance.faults;
  replay::FrameReader images(performance.recording, events);
  for (const Event& event : events) {
    if (replay::stop_requested()) return;
    const double at_s = to_seconds(event.due_ns - first_ns);
    std::optional<Result<DepthImage>> image;
    if (event.kind == Event::Kind::device) image = images.next();
    if (!await(performance, at_s) || (image && !*image)) continue;
    push(device, performance, event, stepped(event.stamp_ns, at_s, faults.device_step_s, faults.step_at_s),
         image ? &**image : nullptr);
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(kAfter_s));
}

}  // namespace

Result<std::string> play_ceiling(const Performance& performance, const wire::DomainOptions& seat) {
  const auto participant = wire::Participant::create(seat);
  if (!participant) return tl::unexpected(participant.error());
  const auto streams = replay::Streams::create(*participant, performance.recording.site, {});
  if (!streams) return tl::unexpected(streams.error());
  const auto events = events_of(performance, true);
  const StampNs first_ns = first_of(performance.recording);
  const StreamFaults& faults = performance.faults;
  replay::FrameReader images(performance.recording, events);
  for (const Event& event : events) {
    if (replay::stop_requested()) break;
    const double at_s = to_seconds(event.due_ns - first_ns);
    auto image = images.next();
    const bool silent = std::ranges::count(faults.silent_lidars, event.source) > 0 &&
                        at_s >= faults.silent_from_s && at_s < faults.silent_to_s;
    if (!await(performance, at_s) || silent || !image) continue;
    image->stamp_ns = stepped(image->stamp_ns, at_s, faults.ceiling_step_s, faults.step_at_s);
    if (const Status sent = streams->ceiling(event.source, *image); !sent) return tl::unexpected(sent.error());
  }
  return std::string("over");
}

Result<std::string> play_device(const Performance& performance, const wire::DomainOptions& seat,
                                const std::filesystem::path& out) {
  auto truth = replay::Truth::of(performance.recording.devices.front());
  if (!truth) return tl::unexpected(truth.error());
  Judge judge(performance, std::move(*truth));
  client::Options options = client_options(performance, seat);
  options.trace_folder = out;
  client::set_log([&performance, file = std::make_shared<std::ofstream>(out / "client.log"),
                   mutex = std::make_shared<std::mutex>()](int level, const std::string& line) {
    if (level < 1) return;
    const std::scoped_lock lock(*mutex);
    *file << fmt::format("{:7.3f} s, level {}: {}\n", performance.now_s(), level, line) << std::flush;
  });
  auto device = client::Client::create(
      options, [&](const client::PoseUpdate& update) { judge.frame(update); },
      [&](const client::Reply& reply) { judge.reply(reply); });
  if (!device) return fail("{}", device.error());
  push_all(*device.value(), performance);
  if (const auto stopped = device.value()->stop(); !stopped) return fail("{}", stopped.error());
  const client::Stats stats = device.value()->stats();
  std::string bytes;
  load::append_rows(judge.story.replies, bytes);
  load::append_rows(judge.story.frames, bytes);
  load::append_rows(std::vector{stats.requests, stats.requests_unsent, stats.requests_unanswered}, bytes);
  return bytes;
}

DeviceStory story_from(std::string_view bytes) {
  DeviceStory story;
  std::vector<std::uint64_t> counts;
  load::take_rows(bytes, story.replies);
  load::take_rows(bytes, story.frames);
  load::take_rows(bytes, counts);
  story.requests = counts[0];
  story.unsent = counts[1];
  story.unanswered = counts[2];
  return story;
}

}  // namespace liloc::faults
