#include "server/tools/recorder.hpp"

#include <system_error>

#include "common/base/distinct_topics.hpp"
#include "common/geometry/depth.hpp"
#include "common/recording/writer.hpp"
#include "common/wire/sensors/sensors.hpp"

namespace liloc::toolbox {
namespace {

namespace fs = std::filesystem;
constexpr int kWriters = 2;  // a core encodes some 1500 images of 320 x 240 a second; by hand

}  // namespace

Status Recorder::check(const Site& site, const std::vector<DeviceInfo>& devices, const fs::path& out) {
  std::error_code error;
  if (fs::exists(out, error) && (!fs::is_directory(out, error) || !fs::is_empty(out, error)))
    return fail("{}: is there already; name a new folder", out.string());
  std::vector<std::string> ids;
  for (const GlobalLidar& lidar : site.global_lidars) ids.push_back(lidar.id);
  for (const DeviceInfo& device : devices) ids.push_back(device.id);
  return check_distinct_topics(ids);
}

Result<std::unique_ptr<Recorder>> Recorder::create(wire::Dispatcher& dispatcher, const Site& site,
                                                   const std::vector<DeviceInfo>& devices,
                                                   const fs::path& out) {
  if (const Status fine = check(site, devices, out); !fine) return tl::unexpected(fine.error());
  std::unique_ptr<Recorder> recorder(new Recorder(out));
  if (const Status opened = recorder->open(dispatcher, site, devices); !opened) {
    std::error_code ignored;
    fs::remove_all(out, ignored);  // it was empty
    return tl::unexpected(opened.error());
  }
  for (int i = 0; i < kWriters; ++i)
    recorder->writers_.emplace_back(
        [raw = recorder.get()](const std::stop_token& stop) { raw->write_frames(stop); });
  return recorder;
}

Status Recorder::open(wire::Dispatcher& dispatcher, const Site& site, const std::vector<DeviceInfo>& devices) {
  if (Status written = write_site(out_ / "site.json", site); !written) return written;
  for (const GlobalLidar& lidar : site.global_lidars)
    if (Status added = add_lidar(dispatcher, lidar); !added) return added;
  for (const DeviceInfo& device : devices)
    if (Status added = add_device(dispatcher, device); !added) return added;
  return {};
}

Recorder::~Recorder() {
  waiting_.close();
}

Result<Recorder::Sensor*> Recorder::add_sensor(const std::string& id, const fs::path& folder,
                                               const Camera& camera) {
  Sensor& sensor = sensors_[id];
  sensor.folder = folder;
  sensor.camera = camera;
  std::error_code error;
  fs::create_directories(folder / "depth", error);
  if (error) return fail("{}: cannot be made ({}); name another folder", folder.string(), error.message());
  return &sensor;
}

Status Recorder::add_lidar(wire::Dispatcher& dispatcher, const GlobalLidar& lidar) {
  const auto sensor = add_sensor(lidar.id, out_ / "global" / lidar.id, lidar.camera);
  if (!sensor) return tl::unexpected(sensor.error());
  Sensor& one = **sensor;
  if (Status subscribed =
          wire::subscribe_depth(dispatcher, lidar.id, lidar.camera.depth_scale_m,
                                [this, &one](Result<DepthImage> image) { take(one, std::move(image)); });
      !subscribed)
    return subscribed;
  return wire::subscribe_points(dispatcher, lidar.id, [this, &one](const Result<wire::StampedCloud>& cloud) {
    take(one, cloud.map([&](const wire::StampedCloud& c) {
      return cloud_to_depth(c.cloud_sensor, one.camera, c.stamp_ns);
    }));
  });
}

Status Recorder::add_device(wire::Dispatcher& dispatcher, const DeviceInfo& device) {
  const fs::path folder = out_ / "devices" / ("." + device.id);  // readers pass over it
  const auto sensor = add_sensor(device.id, folder, device.camera);
  if (!sensor) return tl::unexpected(sensor.error());
  Sensor& one = **sensor;
  one.named = out_ / "devices" / device.id;
  if (Status written = write_device(folder / "device.json", device); !written) return written;
  if (Status subscribed =
          wire::subscribe_depth(dispatcher, device.id, device.camera.depth_scale_m,
                                [this, &one](Result<DepthImage> image) { take(one, std::move(image)); });
      !subscribed)
    return subscribed;
  if (!device.T_imu_sensor) return {};
  if (Status opened = one.imu.open(folder / "imu.csv"); !opened) return opened;
  return wire::subscribe_imu(dispatcher, device.id, [this, &one](const Result<ImuSample>& sample) {
    if (!sample) return refuse(one, sample.error().message);
    const bool taken = one.imu.add(*sample);
    if (!taken && one.imu.written()) return refuse(one, "an IMU sample whose stamp does not rise");
    const std::scoped_lock lock(mutex_);
    one.recorded.samples = one.imu.rows();
    if (trouble_) trouble_ = one.imu.written();
  });
}

void Recorder::refuse(Sensor& sensor, const std::string& why) {
  const std::scoped_lock lock(mutex_);
  ++sensor.recorded.refused;
  sensor.recorded.last_refusal = why;
}

void Recorder::take(Sensor& sensor, Result<DepthImage> image) {
  if (!image) return refuse(sensor, image.error().message);
  if (image->width != sensor.camera.width || image->height != sensor.camera.height)
    return refuse(sensor, fmt::format("an image is {}x{}, the intrinsics are for {}x{}; correct one of them",
                                      image->width, image->height, sensor.camera.width, sensor.camera.height));
  if (const auto displaced = waiting_.push({&sensor, std::move(*image)})) {
    const std::scoped_lock lock(mutex_);
    ++displaced->sensor->recorded.left_out;
  }
}

Result<fs::path> Recorder::folder_of(Sensor& sensor) {
  const std::scoped_lock lock(mutex_);
  if (sensor.named.empty()) return sensor.folder;
  std::error_code error;
  fs::rename(sensor.folder, sensor.named, error);
  if (error)
    return fail("{}: cannot be made ({}); name another folder", sensor.named.string(), error.message());
  sensor.folder = std::exchange(sensor.named, {});
  return sensor.folder;
}

void Recorder::write_frames(const std::stop_token& stop) {
  while (const auto frame = waiting_.pop(stop)) {
    const Status written = folder_of(*frame->sensor).and_then([&](const fs::path& folder) {
      return write_depth(folder / "depth", frame->image);
    });
    const std::scoped_lock lock(mutex_);
    if (written) ++frame->sensor->recorded.frames;
    if (!written && trouble_) trouble_ = written;
  }
}

Status Recorder::trouble() const {
  const std::scoped_lock lock(mutex_);
  return trouble_;
}

std::map<std::string, Recorded> Recorder::recorded() const {
  const std::scoped_lock lock(mutex_);
  std::map<std::string, Recorded> all;
  for (const auto& [id, sensor] : sensors_) all[id] = sensor.recorded;
  return all;
}

Status Recorder::finish() {
  waiting_.close();
  writers_.clear();  // joins: each drains the queue first
  const Status done = trouble();
  for (auto& [id, sensor] : sensors_) {
    std::error_code ignored;
    if (sensor.recorded.frames == 0 && sensor.folder.parent_path().filename() == "devices")
      fs::remove_all(sensor.folder, ignored);
  }
  return done;
}

}  // namespace liloc::toolbox
