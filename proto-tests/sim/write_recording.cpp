#include "proto-tests/sim/write_recording.hpp"

#include <bit>
#include <cstring>

#include "common/recording/files.hpp"
#include "common/recording/writer.hpp"
#include "proto-tests/sim/simulation.hpp"

namespace liloc::sim {
namespace {

namespace fs = std::filesystem;
static_assert(std::endian::native == std::endian::little, "write_ply copies floats as they are");

/// Puts each event where it belongs.
class Recorder {
 public:
  Recorder(const Simulation& simulation, const fs::path& root)
      : simulation_(simulation), root_(root), tables_(simulation.devices().size()) {}

  Status operator()(const LidarFrame& frame) const {
    return write_depth(root_ / "global" / simulation_.site().global_lidars[frame.lidar].id / "depth",
                       frame.image);
  }
  Status operator()(const DeviceFrame& frame) {
    tables_[frame.device].truth.push_back({frame.image.stamp_ns, frame.T_map_sensor});
    return write_depth(folder(frame.device) / "depth", frame.image);
  }
  Status operator()(const DeviceImu& imu) {
    tables_[imu.device].imu.push_back(imu.sample);
    return {};
  }

  Status finish() const {
    for (std::size_t i = 0; i < tables_.size(); ++i) {
      const auto written =
          write_device(folder(i) / "device.json", simulation_.devices()[i])
              .and_then([&] { return write_tum(folder(i) / "groundtruth.tum", tables_[i].truth); })
              .and_then([&] {
                return tables_[i].imu.empty() ? Status{} : write_imu(folder(i) / "imu.csv", tables_[i].imu);
              });
      if (!written) return written;
    }
    for (const auto& lidar : simulation_.site().global_lidars) {  // a LiDAR may have delivered nothing
      std::error_code error;
      fs::create_directories(root_ / "global" / lidar.id / "depth", error);
      if (error) return fail("{}: cannot be made: {}", (root_ / "global" / lidar.id).string(), error.message());
    }
    return write_site(root_ / "site.json", simulation_.site());
  }

 private:
  struct Tables {
    std::vector<ImuSample> imu;
    std::vector<StampedPose> truth;
  };
  [[nodiscard]] fs::path folder(std::size_t device) const {
    return root_ / "devices" / simulation_.devices()[device].id;
  }

  const Simulation& simulation_;
  const fs::path root_;
  std::vector<Tables> tables_;
};

}  // namespace

Status write_recording(const SimOptions& options, const fs::path& root, const Progress& progress) {
  std::error_code error;
  for (const char* part : {"site.json", "global", "devices"})
    if (fs::exists(root / part, error))
      return fail("{}: is there already; choose another folder or remove it", (root / part).string());
  auto simulation = Simulation::create(options);
  if (!simulation) return tl::unexpected(simulation.error());
  const auto scan = simulation->reference_scan();
  if (!scan) return tl::unexpected(scan.error());
  if (auto written = write_ply(root / "reference.ply", *scan); !written) return written;
  Recorder recorder(*simulation, root);
  while (auto event = simulation->next()) {
    if (auto written = std::visit(recorder, event->payload); !written) return written;
    const bool frame = !std::holds_alternative<DeviceImu>(event->payload);
    if (progress && frame) progress(to_seconds(event->at_ns - simulation->start_ns()) / options.seconds);
  }
  auto done = recorder.finish();
  if (done && progress) progress(1);
  return done;
}

Status write_ply(const fs::path& file, const Cloud& cloud) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "end_header\n",
      cloud.size());
  const std::size_t header = bytes.size();
  bytes.resize(header + cloud.size() * sizeof(Eigen::Vector3f));
  std::memcpy(bytes.data() + header, cloud.points.data(), cloud.size() * sizeof(Eigen::Vector3f));
  return write_file(file, bytes);
}

}  // namespace liloc::sim
