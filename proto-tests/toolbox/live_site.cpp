#include "proto-tests/toolbox/live_site.hpp"

#include <algorithm>
#include <chrono>

#include "common/recording/writer.hpp"

namespace liloc::toolbox {

using Clock = std::chrono::steady_clock;
// Of two frames at 6 Hz: what comes later than that is no live stream.
constexpr auto kMostBehind = std::chrono::milliseconds(300);

Result<std::unique_ptr<LiveSite>> LiveSite::create(const sim::SimOptions& options, int domain,
                                                   const std::string& credentials) {
  auto simulation = sim::Simulation::create(options);
  if (!simulation) return tl::unexpected(simulation.error());
  wire::DomainOptions seat;
  seat.domain = domain;
  seat.credentials = credentials;
  seat.role = wire::Role::source;
  auto participant = wire::Participant::create(seat);
  if (!participant) return tl::unexpected(participant.error());
  auto streams = replay::Streams::create(*participant, simulation->site(), simulation->devices());
  if (!streams) return tl::unexpected(streams.error());
  return std::unique_ptr<LiveSite>(
      new LiveSite(std::move(*participant), std::move(*simulation), std::move(*streams)));
}

LiveSite::LiveSite(wire::Participant participant, sim::Simulation simulation, replay::Streams streams)
    : participant_(std::move(participant)),
      simulation_(std::move(simulation)),
      streams_(std::move(streams)),
      site_(simulation_.site()),
      devices_(simulation_.devices()),
      truths_(devices_.size()),
      first_frames_ns_(devices_.size(), 0) {}

Status LiveSite::describe(const std::filesystem::path& folder) const {
  if (auto status = write_site(folder / "site.json", site_); !status) return status;
  for (const DeviceInfo& device : devices_)
    if (auto status = write_device(folder / (device.id + ".json"), device); !status) return status;
  return {};
}

void LiveSite::start() {
  worker_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void LiveSite::run(const std::stop_token& stop) {
  const auto start = Clock::now();
  while (!stop.stop_requested()) {
    const auto event = simulation_.next();
    if (!event) break;
    const auto due = start + std::chrono::nanoseconds(event->at_ns - simulation_.start_ns());
    std::this_thread::sleep_until(due);
    const auto late = Clock::now() - due;
    if (late > kMostBehind)
      dropped_ += simulation_.skip_images_before(event->at_ns + std::chrono::nanoseconds(late).count());
    if (auto status = send(*event); !status) {
      const std::scoped_lock lock(mutex_);
      trouble_ = status;
      break;
    }
  }
  over_ = true;
}

Status LiveSite::send(const sim::SimEvent& event) {
  if (const auto* frame = std::get_if<sim::LidarFrame>(&event.payload))
    return streams_.ceiling(frame->lidar, frame->image);
  if (const auto* imu = std::get_if<sim::DeviceImu>(&event.payload))
    return streams_.imu(imu->device, imu->sample);
  const auto& frame = std::get<sim::DeviceFrame>(event.payload);
  remember(frame);
  return streams_.device(frame.device, frame.image);
}

void LiveSite::remember(const sim::DeviceFrame& frame) {
  const std::scoped_lock lock(mutex_);
  auto& truths = truths_[frame.device];
  truths[frame.image.stamp_ns] = frame.T_map_sensor;
  truths.erase(truths.begin(), truths.lower_bound(frame.image.stamp_ns - from_seconds(60)));
  if (first_frames_ns_[frame.device] == 0) first_frames_ns_[frame.device] = frame.image.stamp_ns;
}

Status LiveSite::trouble() const {
  const std::scoped_lock lock(mutex_);
  return trouble_;
}

std::optional<Pose> LiveSite::truth(std::size_t device, StampNs stamp_ns) const {
  const std::scoped_lock lock(mutex_);
  const auto found = truths_[device].find(stamp_ns);
  if (found == truths_[device].end()) return std::nullopt;
  return found->second;
}

StampNs LiveSite::first_frame_ns(std::size_t device) const {
  const std::scoped_lock lock(mutex_);
  return first_frames_ns_[device];
}

}  // namespace liloc::toolbox
