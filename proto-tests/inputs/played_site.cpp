#include "proto-tests/inputs/played_site.hpp"

#include "common/base/stamp.hpp"
#include "common/geometry/depth.hpp"
#include "common/recording/writer.hpp"

namespace liloc::inputs {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kClouds = 1, kWheels = 2;  // the devices that send those
constexpr StampNs kHour = from_seconds(3600);
constexpr auto kMostBehind = std::chrono::milliseconds(300);  // of two frames at 6 Hz; images are left out then

}  // namespace

/// The topics of one domain.
struct PlayedSite::Outlet {
  [[nodiscard]] static Result<Outlet> create(int domain, const sim::Simulation& simulation);

  wire::Participant seat;
  std::vector<wire::DepthPublisher> ceiling = {};
  std::vector<wire::DepthPublisher> depth = {};
  std::vector<wire::ImuPublisher> imu = {};
  std::vector<wire::PointsPublisher> clouds = {};  ///< one, of kClouds
  std::vector<wire::RosPublisher> wheels = {};     ///< one, of kWheels
};

Result<PlayedSite::Outlet> PlayedSite::Outlet::create(int domain, const sim::Simulation& simulation) {
  auto seat = wire::Participant::create({.domain = domain, .role = wire::Role::source});
  if (!seat) return tl::unexpected(seat.error());
  Outlet outlet{*seat};
  Status made;
  const auto keep = [&made](auto& list, auto publisher) {
    if (publisher)
      list.push_back(std::move(*publisher));
    else
      made = tl::unexpected(publisher.error());
  };
  for (const GlobalLidar& lidar : simulation.site().global_lidars)
    keep(outlet.ceiling, wire::DepthPublisher::create(*seat, lidar.id, lidar.camera));
  for (std::size_t i = 0; i < simulation.devices().size(); ++i) {
    const DeviceInfo& device = simulation.devices()[i];
    keep(outlet.depth, wire::DepthPublisher::create(*seat, device.id, device.camera));
    keep(outlet.imu, wire::ImuPublisher::create(*seat, device.id));
    if (i == kClouds) keep(outlet.clouds, wire::PointsPublisher::create(*seat, device.id));
    if (i == kWheels)
      keep(outlet.wheels, wire::RosPublisher::create(*seat, device.id, wire::RosNames::of(device.id)));
  }
  if (!made) return tl::unexpected(made.error());
  return outlet;
}

Result<std::unique_ptr<PlayedSite>> PlayedSite::start(sim::SimOptions options,
                                                      const std::vector<int>& domains) {
  options.start_stamp_ns = wall_clock_ns();
  auto simulation = sim::Simulation::create(options);
  if (!simulation) return tl::unexpected(simulation.error());
  std::vector<Outlet> outlets;
  for (const int domain : domains) {
    auto outlet = Outlet::create(domain, *simulation);
    if (!outlet) return tl::unexpected(outlet.error());
    outlets.push_back(std::move(*outlet));
  }
  std::unique_ptr<PlayedSite> site(new PlayedSite(std::move(*simulation), std::move(outlets)));
  site->worker_ = std::jthread([raw = site.get()](const std::stop_token& stop) { raw->run(stop); });
  return site;
}

PlayedSite::PlayedSite(sim::Simulation simulation, std::vector<Outlet> outlets)
    : simulation_(std::move(simulation)),
      site_(simulation_.site()),
      devices_(simulation_.devices()),
      outlets_(std::move(outlets)),
      truths_(devices_.size()) {}

PlayedSite::~PlayedSite() = default;

Status PlayedSite::describe(const std::filesystem::path& folder) const {
  if (auto status = write_site(folder / "site.json", site_); !status) return status;
  for (const DeviceInfo& device : devices_)
    if (auto status = write_device(folder / (device.id + ".json"), device); !status) return status;
  return {};
}

void PlayedSite::run(const std::stop_token& stop) {
  const auto start = Clock::now() - std::chrono::nanoseconds(wall_clock_ns() - simulation_.start_ns());
  while (!stop.stop_requested()) {
    auto event = simulation_.next();
    if (!event) break;
    const auto due = start + std::chrono::nanoseconds(event->at_ns - simulation_.start_ns());
    std::this_thread::sleep_until(due);
    if (const auto late = Clock::now() - due; late > kMostBehind)
      simulation_.skip_images_before(event->at_ns + std::chrono::nanoseconds(late).count());
    if (const Status sent = send(*event); !sent) {
      const std::scoped_lock lock(mutex_);
      trouble_ = sent;
      break;
    }
  }
}

Status PlayedSite::send(sim::SimEvent& event) {
  return std::visit([this](auto& payload) { return send(payload); }, event.payload);
}

Status PlayedSite::send(sim::LidarFrame& frame) {
  frame.image.stamp_ns += spoil.lidar_ahead_ns.at(frame.lidar);
  if (auto* const change = spoil.lidar_image.at(frame.lidar).load()) change(frame.image);
  for (const Outlet& outlet : outlets_)
    if (Status sent = outlet.ceiling[frame.lidar].publish(frame.image); !sent) return sent;
  return {};
}

Status PlayedSite::send(sim::DeviceFrame& frame) {
  if (spoil.devices_silent) return {};
  if (auto* const change = spoil.device_image.at(frame.device).load()) change(frame.image);
  const StampNs stamp_ns = frame.image.stamp_ns += spoil.device_ahead_ns;
  {
    const std::scoped_lock lock(mutex_);
    truths_[frame.device][stamp_ns] = frame.T_map_sensor;
  }
  for (const Outlet& outlet : outlets_)
    if (frame.device == kWheels)
      if (Status sent = outlet.wheels.front().publish_odometry(
              stamp_ns + (spoil.stray_odometry.exchange(false) ? kHour : 0), frame.T_map_sensor);
          !sent)
        return sent;
  if (spoil.stray_frame.at(frame.device).exchange(false)) frame.image.stamp_ns += kHour;
  const Camera& camera = devices_[frame.device].camera;
  for (const Outlet& outlet : outlets_) {
    const Status sent = frame.device == kClouds
                            ? depth_to_cloud(frame.image, camera).and_then([&](const Cloud& cloud) {
                                return outlet.clouds.front().publish(frame.image.stamp_ns, cloud);
                              })
                            : outlet.depth[frame.device].publish(frame.image);
    if (!sent) return sent;
  }
  return {};
}

Status PlayedSite::send(sim::DeviceImu& imu) {
  if (spoil.devices_silent) return {};
  imu.sample.stamp_ns += spoil.device_ahead_ns;
  if (auto* const change = spoil.imu.at(imu.device).load()) change(imu.sample);
  if (spoil.stray_imu.at(imu.device).exchange(false)) imu.sample.stamp_ns += kHour;
  for (const Outlet& outlet : outlets_)
    if (Status sent = outlet.imu[imu.device].publish(imu.sample); !sent) return sent;
  return {};
}

std::optional<Pose> PlayedSite::truth(std::size_t device, StampNs stamp_ns) const {
  const std::scoped_lock lock(mutex_);
  const auto found = truths_[device].find(stamp_ns);
  if (found == truths_[device].end()) return std::nullopt;
  return found->second;
}

Status PlayedSite::trouble() const {
  const std::scoped_lock lock(mutex_);
  return trouble_;
}

}  // namespace liloc::inputs
