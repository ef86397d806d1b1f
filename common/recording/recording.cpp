#include "common/recording/recording.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace liloc {
namespace {

namespace fs = std::filesystem;

/// The entries of a folder by name, without hidden ones (unfinished writes, what a desktop leaves behind).
Result<std::vector<fs::path>> list(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> entries;
  fs::directory_iterator it(folder, error);
  if (error)
    return fail("{}: cannot be listed: {}; check the recording's layout", folder.string(), error.message());
  for (; it != fs::directory_iterator(); it.increment(error)) {
    if (error) return fail("{}: cannot be listed: {}", folder.string(), error.message());
    if (it->path().filename().string().front() != '.') entries.push_back(it->path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

Result<std::vector<DepthFile>> list_depth(const fs::path& folder) {
  const auto entries = list(folder);
  if (!entries) return tl::unexpected(entries.error());
  std::vector<DepthFile> files;
  files.reserve(entries->size());
  for (const auto& path : *entries) {
    const std::string stem = path.stem().string();
    StampNs stamp_ns = -1;
    const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), stamp_ns);
    if (path.extension() != ".png" || error != std::errc() || end != stem.data() + stem.size() || stamp_ns < 0)
      return fail("{}: is not named <stamp_ns>.png; rename or remove it", path.string());
    std::error_code unknown;
    if (!fs::is_regular_file(path, unknown))  // a pipe of that name would be waited for
      return fail("{}: is named like a frame but is no file; remove it", path.string());
    files.push_back({stamp_ns, path});
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.stamp_ns < b.stamp_ns; });
  const auto twin = std::adjacent_find(files.begin(), files.end(),
                                       [](const auto& a, const auto& b) { return a.stamp_ns == b.stamp_ns; });
  if (twin != files.end())
    return fail("{}: another file has the same stamp {}; remove one", twin->path.string(), twin->stamp_ns);
  return files;
}

Result<DeviceRecording> open_device(const fs::path& folder) {
  DeviceRecording device;
  device.folder = folder;
  auto info = read_device(folder / "device.json");
  if (!info) return tl::unexpected(info.error());
  if (info->id != folder.filename().string())
    return fail("{}: id is '{}' but the folder is '{}'; make them equal", (folder / "device.json").string(),
                info->id, folder.filename().string());
  device.info = std::move(*info);
  auto depth = list_depth(folder / "depth");
  if (!depth) return tl::unexpected(depth.error());
  if (depth->empty())
    return fail("{}: holds no frame; remove the device or add frames", (folder / "depth").string());
  device.depth = std::move(*depth);
  if (fs::exists(folder / "imu.csv")) {
    auto imu = read_imu(folder / "imu.csv");
    if (!imu) return tl::unexpected(imu.error());
    device.imu = std::move(*imu);
  }
  return device;
}

}  // namespace

Result<Recording> open_recording(const fs::path& root) {
  std::error_code error;
  if (!fs::is_directory(root, error))
    return fail("{}: is no folder; give a recording, which holds site.json and global/", root.string());
  Recording recording;
  recording.root = root;
  auto site = read_site(root / "site.json");
  if (!site) return tl::unexpected(site.error());
  recording.site = std::move(*site);
  for (const auto& lidar : recording.site.global_lidars) {
    auto depth = list_depth(root / "global" / lidar.id / "depth");
    if (!depth) return tl::unexpected(depth.error());
    recording.lidars.push_back({lidar, std::move(*depth)});
  }
  if (!fs::exists(root / "devices", error)) return recording;
  const auto folders = list(root / "devices");
  if (!folders) return tl::unexpected(folders.error());
  for (const auto& folder : *folders) {
    auto device = open_device(folder);
    if (!device) return tl::unexpected(device.error());
    recording.devices.push_back(std::move(*device));
  }
  return recording;
}

Result<std::vector<StampedPose>> read_ground_truth(const DeviceRecording& device) {
  const auto file = device.folder / "groundtruth.tum";
  std::error_code error;
  if (!fs::exists(file, error)) return std::vector<StampedPose>{};
  return read_tum(file);
}

}  // namespace liloc
