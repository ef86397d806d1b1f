#include "server/ingest/ingest.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/log.hpp"
#include "common/base/quantile.hpp"
#include "common/base/stamp_clock.hpp"
#include "common/wire/sensors.hpp"
#include "server/ingest/lidar_monitor.hpp"

namespace liloc {
namespace {

using Clock = std::chrono::steady_clock;

Status same_size(const GlobalLidar& lidar, std::string_view what, int width, int height) {
  if (width == lidar.camera.width && height == lidar.camera.height) return {};
  return fail("{} is {} x {}, the site says {} x {}; correct the site or the driver", what, width, height,
              lidar.camera.width, lidar.camera.height);
}

bool focal_differs(const Camera& a, const Camera& b) {
  return std::abs(a.fx / b.fx - 1) > 0.01 || std::abs(a.fy / b.fy - 1) > 0.01;
}

/// A cloud may have more points than the camera has pixels.
double share_of(std::size_t returns, const Camera& camera) {
  return std::min(1.0, static_cast<double>(returns) / (static_cast<double>(camera.width) * camera.height));
}

}  // namespace

struct Ingest::Lidar {
  GlobalLidar info;
  LidarMonitor monitor;
  wire::LidarState reported = wire::LidarState::waiting;
  bool camera_reported = false;
  StampNs newest_ns = 0;
  double valid_share = 0;
  StampClock clock{};
};

Ingest::Ingest(FrameSink sink) : sink_(std::move(sink)) {}
Ingest::~Ingest() = default;

Result<std::unique_ptr<Ingest>> Ingest::create(wire::Dispatcher& dispatcher, const Site& site, FrameSink sink) {
  if (site.global_lidars.empty()) return fail("site has no global_lidars; nothing could be localized against");
  std::unique_ptr<Ingest> ingest(new Ingest(std::move(sink)));
  for (const auto& lidar : site.global_lidars)
    ingest->lidars_.push_back(
        std::make_unique<Lidar>(Lidar{lidar, LidarMonitor(lidar.id, lidar.rate_hz, Clock::now())}));
  for (std::size_t i = 0; i < ingest->lidars_.size(); ++i)
    if (auto subscribed = ingest->subscribe(dispatcher, i); !subscribed)
      return tl::unexpected(subscribed.error());
  dispatcher.every(std::chrono::milliseconds(200), [self = ingest.get()] { self->report_changes(); });
  return ingest;
}

Status Ingest::subscribe(wire::Dispatcher& dispatcher, std::size_t index) {
  const GlobalLidar& lidar = lidars_[index]->info;
  const auto on_depth = [this, index, &lidar](Result<DepthImage> image) {
    if (!image) return drop(index, image.error().message);
    if (auto size = same_size(lidar, "depth image", image->width, image->height); !size)
      return drop(index, size.error().message);
    const StampNs stamp_ns = image->stamp_ns;
    const double valid = share_of(
        image->units.size() - static_cast<std::size_t>(std::ranges::count(image->units, 0)), lidar.camera);
    take(index, stamp_ns, valid, sink_.add_depth(index, std::move(*image)));
  };
  const auto on_points = [this, index, &lidar](const Result<wire::StampedCloud>& cloud) {
    if (!cloud) return drop(index, cloud.error().message);
    take(index, cloud->stamp_ns, share_of(cloud->cloud_sensor.size(), lidar.camera),
         sink_.add_points(index, cloud->stamp_ns, cloud->cloud_sensor));
  };
  if (auto ok = wire::subscribe_depth(dispatcher, lidar.id, lidar.camera.depth_scale_m, on_depth); !ok)
    return ok;
  if (auto ok = wire::subscribe_points(dispatcher, lidar.id, on_points); !ok) return ok;
  return wire::subscribe_camera_info(dispatcher, lidar.id,
                                     [this, index](const Result<Camera>& info) { check_camera(index, info); });
}

void Ingest::take(std::size_t index, StampNs stamp_ns, double valid_share, const Status& taken) {
  if (!taken) return drop(index, taken.error().message);
  {
    const std::scoped_lock lock(mutex_);
    lidars_[index]->monitor.on_frame(Clock::now());
    lidars_[index]->newest_ns = stamp_ns;
    lidars_[index]->valid_share = valid_share;
    if (lidars_[index]->clock.add(stamp_ns, Clock::now()))
      log::warning("{}: its clock was set to {} ns", lidars_[index]->info.id, stamp_ns);
  }
  if (sink_.on_frame) sink_.on_frame();
}

void Ingest::drop(std::size_t index, const std::string& error) {
  const std::scoped_lock lock(mutex_);
  lidars_[index]->monitor.on_malformed(Clock::now(), error);
}

void Ingest::check_camera(std::size_t index, const Result<Camera>& info) {
  auto& lidar = *lidars_[index];
  if (!info) return drop(index, info.error().message);
  if (lidar.camera_reported) return;  // only this thread looks at it
  if (auto size = same_size(lidar.info, "camera_info", info->width, info->height); !size) {
    lidar.camera_reported = true;  // once: it comes with every image
    return drop(index, size.error().message);
  }
  if (!focal_differs(*info, lidar.info.camera)) return;
  lidar.camera_reported = true;
  log::warning("{}: camera_info has focal length {:.2f}, {:.2f}, the site {:.2f}, {:.2f}; the site's is used",
               lidar.info.id, info->fx, info->fy, lidar.info.camera.fx, lidar.info.camera.fy);
}

void Ingest::report_changes() {
  const auto now = Clock::now();
  for (auto& lidar : lidars_) {
    wire::LidarHealth health;
    {
      const std::scoped_lock lock(mutex_);
      health = lidar->monitor.assess(now);
    }
    if (health.state == lidar->reported) continue;
    lidar->reported = health.state;  // only this thread looks at it
    switch (health.state) {
      case wire::LidarState::ok:
        log::info("{}: ok at {:.1f} Hz", health.id, health.measured_hz);
        break;
      case wire::LidarState::slow:
        log::warning("{}: slow, {:.1f} Hz of {:.1f}", health.id, health.measured_hz, lidar->info.rate_hz);
        break;
      case wire::LidarState::silent:
        log::warning("{}: silent; is it running, and does it send rt/{}/depth/image_rect_raw in this domain?",
                     health.id, health.id);
        break;
      case wire::LidarState::malformed:
        log::warning("{}: malformed: {}", health.id, health.last_error);
        break;
      case wire::LidarState::waiting:
        break;
    }
  }
}

std::vector<wire::LidarHealth> Ingest::health() const {
  const auto now = Clock::now();
  const std::scoped_lock lock(mutex_);
  std::vector<wire::LidarHealth> health;
  for (const auto& lidar : lidars_) health.push_back(lidar->monitor.assess(now));
  return health;
}

std::vector<LidarActivity> Ingest::activity() const {
  const auto now = Clock::now();
  const std::scoped_lock lock(mutex_);
  std::vector<LidarActivity> activity;
  for (const auto& lidar : lidars_) activity.push_back({lidar->monitor.age_s(now), lidar->valid_share});
  return activity;
}

StampNs Ingest::ceiling_now(Clock::time_point at) const {
  std::vector<StampNs> clocks;
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& lidar : lidars_)
      if (const auto now = lidar->clock.now(at)) clocks.push_back(*now);
  }
  if (clocks.empty()) return 0;
  return median(std::move(clocks));
}

bool Ingest::seen(StampNs stamp_ns) const {
  const auto now = Clock::now();
  const std::scoped_lock lock(mutex_);
  return std::ranges::all_of(lidars_, [&](const auto& lidar) {
    if (lidar->newest_ns >= stamp_ns) return true;
    const auto state = lidar->monitor.assess(now).state;
    return state != wire::LidarState::ok &&
           state != wire::LidarState::slow;  // nobody waits for one that is out
  });
}

}  // namespace liloc
