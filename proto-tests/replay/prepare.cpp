#include "proto-tests/replay/prepare.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <set>

#include "proto-tests/replay/truth.hpp"

namespace liloc::replay {
namespace {

namespace fs = std::filesystem;

/// A frame that says itself that it is no depth image of this camera spoils the recording. One that is merely
/// damaged is left to the replay, which skips it.
Status check_header(const DepthFile& file, const Camera& camera) {
  std::array<unsigned char, 26> head{};
  std::ifstream in(file.path, std::ios::binary);
  in.read(reinterpret_cast<char*>(head.data()), head.size());
  constexpr std::array<unsigned char, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (!in || !std::equal(kSignature.begin(), kSignature.end(), head.begin())) return {};
  const auto number = [&](std::size_t at) {
    return head[at] << 24 | head[at + 1] << 16 | head[at + 2] << 8 | head[at + 3];
  };
  const int width = number(16), height = number(20), bits = head[24], colour = head[25];
  if (bits != 16 || colour != 0)
    return fail("{}: has {} bits a sample and PNG colour type {}; depth must be 16-bit greyscale (type 0)",
                file.path.string(), bits, colour);
  if (width != camera.width || height != camera.height)
    return fail("{}: is {}x{}, its intrinsics are for {}x{}; correct one of them", file.path.string(), width,
                height, camera.width, camera.height);
  return {};
}

Status check_headers(const std::vector<DepthFile>& files, const Camera& camera) {
  for (const DepthFile& file : files)
    if (auto status = check_header(file, camera); !status) return status;
  return {};
}

Status check_device(const DeviceRecording& device, const ReplayOptions& options) {
  if (auto status = check_headers(device.depth, device.info.camera); !status) return status;
  if (options.local != "cloud" && (device.imu.empty() || !device.info.T_imu_sensor))
    return fail("{}: --local {} needs imu.csv and T_imu_sensor in device.json; use --local cloud",
                device.folder.string(), options.local);
  const auto truth = Truth::of(device);
  if (!truth) return tl::unexpected(truth.error());
  if (truth->empty() && options.save_answers.ends_with(":wrong"))
    return fail("{}: --save-answers of wrong ones needs groundtruth.tum; give DIR:refused or DIR:all",
                device.folder.string());
  return {};
}

Status choose_devices(Recording& recording, const std::vector<std::string>& ids) {
  if (ids.empty()) return {};
  std::string known;
  for (const auto& device : recording.devices) known += (known.empty() ? "" : ", ") + device.info.id;
  for (const std::string& id : ids)
    if (std::none_of(recording.devices.begin(), recording.devices.end(),
                     [&](const auto& d) { return d.info.id == id; }))
      return fail("--device: {} has no device '{}'; it has {}", recording.root.string(), id,
                  known.empty() ? "none" : known);
  std::erase_if(recording.devices, [&](const auto& device) {
    return std::find(ids.begin(), ids.end(), device.info.id) == ids.end();
  });
  return {};
}

bool is_ours(const fs::directory_entry& entry) {
  static const std::set<std::string> traces{"online.tum", "trajectory.tum", "spots.csv",
                                            "local.csv",  "doubt.csv",      "client.log"};
  const std::string name = entry.path().filename();
  if (!entry.is_directory()) return name == "report.json" || name == "server.log" || name == "site.json";
  return std::all_of(fs::directory_iterator(entry.path()), fs::directory_iterator(), [](const auto& inner) {
    return !inner.is_directory() && traces.contains(inner.path().filename().string());
  });
}

}  // namespace

Result<Recording> open_for_replay(const ReplayOptions& options) {
  if (const auto checked = options.validated(); !checked) return tl::unexpected(checked.error());
  auto recording = open_recording(options.recording);
  if (!recording) return recording;
  if (auto status = choose_devices(*recording, options.devices); !status) return tl::unexpected(status.error());
  for (const LidarRecording& lidar : recording->lidars)
    if (auto status = check_headers(lidar.depth, lidar.info.camera); !status)
      return tl::unexpected(status.error());
  for (const DeviceRecording& device : recording->devices)
    if (auto status = check_device(device, options); !status) return tl::unexpected(status.error());
  return recording;
}

Status prepare_out(const fs::path& out) {
  std::error_code error;
  if (fs::exists(out, error) && !fs::is_directory(out, error))
    return fail("{}: is a file; name a folder for --out", out.string());
  fs::create_directories(out, error);
  if (error)
    return fail("{}: cannot be made ({}); name another folder for --out", out.string(), error.message());
  try {
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(out)) {
      if (!is_ours(entry))
        return fail("{}: holds {}, which no replay wrote; name an empty folder for --out", out.string(),
                    entry.path().filename().string());
      old.push_back(entry.path());
    }
    for (const fs::path& path : old) fs::remove_all(path);
  } catch (const fs::filesystem_error& trouble) {
    return fail("{}: cannot be cleared ({}); name another folder for --out", out.string(),
                trouble.code().message());
  }
  return {};
}

EngineOptions engine_options_of(const DeviceInfo& device, bool with_imu) {
  EngineOptions options;
  options.client_id = device.id;
  options.camera = device.camera;
  options.still_seconds = device.still_seconds;
  if (with_imu) options.T_imu_sensor = device.T_imu_sensor;
  return options;
}

fs::path trace_folder(const ReplayOptions& options, const std::string& device_id) {
  return options.out / device_id;
}

}  // namespace liloc::replay
