#include "server/ingest/ingest.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/line_limit.hpp"
#include "common/base/log.hpp"
#include "common/wire/sensors/sensors.hpp"
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

/// A line for the log; `doctor` has the remedies.
void report(const wire::LidarHealth& health, double rate_hz) {
  switch (health.state) {
    case wire::LidarState::ok:
      return log::info("{}: ok at {:.1f} Hz", health.id, health.measured_hz);
    case wire::LidarState::slow:
      return log::warning("{}: slow, {:.1f} Hz of {:.1f}", health.id, health.measured_hz, rate_hz);
    case wire::LidarState::silent:
      return log::warning(
          "{}: silent; is it running, and does it send rt/{}/depth/image_rect_raw in this domain?", health.id,
          health.id);
    case wire::LidarState::malformed:
      return log::warning("{}: malformed: {}", health.id, health.last_error);
    case wire::LidarState::blind:
      return log::warning("{}: blind: {:.1f} % of its pixels measure anything; is it covered, is its laser on?",
                          health.id, 100 * health.returns);
    case wire::LidarState::implausible:
      return log::warning(
          "{}: implausible: its median range is {:.3g} m{}; is depth_scale right, is it covered?", health.id,
          health.range_m,
          health.usual_range_m > 0 ? fmt::format(", it used to be {:.3g} m", health.usual_range_m) : "");
    case wire::LidarState::clock_off:
      return log::warning(
          "{}: its clock is {:.2f} s {} the site's: its frames are left out until that holds steady", health.id,
          std::abs(health.clock_offset_s), health.clock_offset_s > 0 ? "ahead of" : "behind");
    case wire::LidarState::waiting:
      return;
  }
}

}  // namespace

struct Ingest::Lidar {
  GlobalLidar info;
  LidarMonitor monitor;
  wire::LidarState reported = wire::LidarState::waiting;
  LineLimit lines{}, clock_lines{};
  bool camera_reported = false, correction_reported = false;
  StampNs newest_ns = 0;  ///< by the site's clock
};

Ingest::Ingest(FrameSink sink) : sink_(std::move(sink)) {}
Ingest::~Ingest() = default;

Result<std::unique_ptr<Ingest>> Ingest::create(wire::Dispatcher& dispatcher, const Site& site, FrameSink sink) {
  if (site.global_lidars.empty()) return fail("site has no global_lidars; nothing could be localized against");
  std::unique_ptr<Ingest> ingest(new Ingest(std::move(sink)));
  for (const auto& lidar : site.global_lidars)
    ingest->lidars_.push_back(
        std::make_unique<Lidar>(Lidar{lidar, LidarMonitor(lidar.id, lidar.rate_hz, Clock::now())}));
  ingest->clocks_ = SiteClocks(ingest->lidars_.size());
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
    take(index, image->stamp_ns, content_of(*image, lidar.camera), [&](StampNs stamp_ns) {
      image->stamp_ns = stamp_ns;
      return sink_.add_depth(index, std::move(*image));
    });
  };
  const auto on_points = [this, index, &lidar](const Result<wire::StampedCloud>& cloud) {
    if (!cloud) return drop(index, cloud.error().message);
    take(index, cloud->stamp_ns, content_of(cloud->cloud_sensor, lidar.camera),
         [&](StampNs stamp_ns) { return sink_.add_points(index, stamp_ns, cloud->cloud_sensor); });
  };
  if (auto ok = wire::subscribe_depth(dispatcher, lidar.id, lidar.camera.depth_scale_m, on_depth); !ok)
    return ok;
  if (auto ok = wire::subscribe_points(dispatcher, lidar.id, on_points); !ok) return ok;
  return wire::subscribe_camera_info(dispatcher, lidar.id,
                                     [this, index](const Result<Camera>& info) { check_camera(index, info); });
}

void Ingest::take(std::size_t index, StampNs stamp_ns, const FrameContent& content,
                  const std::function<Status(StampNs)>& add) {
  const auto now = Clock::now();
  std::optional<StampNs> site_stamp_ns;
  {
    const std::scoped_lock lock(mutex_);
    site_stamp_ns = clocks_.add(index, stamp_ns, now, wall_clock_ns());
  }
  if (site_stamp_ns)
    if (const Status taken = add(*site_stamp_ns); !taken) return drop(index, taken.error().message);
  {
    const std::scoped_lock lock(mutex_);
    lidars_[index]->monitor.on_frame(now, content);
    if (!site_stamp_ns) return;
    lidars_[index]->newest_ns = *site_stamp_ns;
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

/// Its lock held.
wire::LidarHealth Ingest::assess(std::size_t index, Clock::time_point now) const {
  wire::LidarHealth health = lidars_[index]->monitor.assess(now);
  const LidarClock offset = clocks_.offset(index);
  health.clock_offset_s = to_seconds(offset.ahead_ns);
  health.clock_corrected = offset.corrected;
  if (offset.left_out && health.state != wire::LidarState::waiting &&
      health.state != wire::LidarState::silent && health.state != wire::LidarState::malformed)
    health.state = wire::LidarState::clock_off;
  return health;
}

void Ingest::report_changes() {
  const auto now = Clock::now();
  for (std::size_t i = 0; i < lidars_.size(); ++i) {
    Lidar& lidar = *lidars_[i];  // what was reported is this thread's alone
    wire::LidarHealth health;
    {
      const std::scoped_lock lock(mutex_);
      health = assess(i, now);
    }
    if (!health.clock_corrected) {
      lidar.correction_reported = false;
    } else if (!lidar.correction_reported && lidar.clock_lines.pass(now)) {
      lidar.correction_reported = true;
      log::warning("{}: its clock is {:.2f} s {} the site's: its stamps are corrected; set it by NTP or PTP",
                   health.id, std::abs(health.clock_offset_s),
                   health.clock_offset_s > 0 ? "ahead of" : "behind");
    }
    if (health.state == lidar.reported) continue;
    // Whoever sends under a LiDAR's name can make it change with every frame: what is held back shows when it
    // stays.
    if (!lidar.lines.pass(now)) continue;
    lidar.reported = health.state;
    report(health, lidar.info.rate_hz);
  }
}

std::vector<wire::LidarHealth> Ingest::health() const {
  const auto now = Clock::now();
  const std::scoped_lock lock(mutex_);
  std::vector<wire::LidarHealth> health;
  for (std::size_t i = 0; i < lidars_.size(); ++i) health.push_back(assess(i, now));
  return health;
}

std::vector<std::optional<double>> Ingest::ages_s() const {
  const auto now = Clock::now();
  const std::scoped_lock lock(mutex_);
  std::vector<std::optional<double>> ages_s;
  for (const auto& lidar : lidars_) ages_s.push_back(lidar->monitor.age_s(now));
  return ages_s;
}

StampNs Ingest::ceiling_now(Clock::time_point at) const {
  const std::scoped_lock lock(mutex_);
  return clocks_.now(at).value_or(0);
}

std::optional<StampNs> Ingest::seen_until() const {
  const auto now = Clock::now();
  const std::scoped_lock lock(mutex_);
  std::optional<StampNs> until;
  for (std::size_t i = 0; i < lidars_.size(); ++i) {
    const StampNs newest_ns = lidars_[i]->newest_ns;
    if ((!until || newest_ns < *until) && wire::is_heard(assess(i, now).state)) until = newest_ns;
  }
  return until;
}

}  // namespace liloc
