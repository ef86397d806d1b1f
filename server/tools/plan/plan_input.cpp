#include "server/tools/plan/plan_input.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "common/recording/json_fields.hpp"
#include "common/recording/recording.hpp"
#include "server/tools/cloud_file.hpp"
#include "server/tools/plan/dxf_file.hpp"
#include "server/tools/plan/floor_image.hpp"

namespace liloc::toolbox {
namespace {

/// A RealSense L515 at 640 x 480 (paper, Table 1): 70 x 55 degrees, a quarter of a millimetre a unit.
constexpr Camera kL515{640, 480, 457, 461, 319.5, 239.5, 0.00025};
constexpr double kHeadroom_m = 2.0;  // between floor and ceiling, for a LiDAR above people; by hand

std::string ending_of(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

Result<Cloud> floor_plan_cloud(const PlanArguments& arguments) {
  const std::string& file = arguments.floor_plan;
  if (!arguments.height_m)
    return fail("--floor-plan: {} tells no height; give --height, metres from floor to ceiling", file);
  const std::string ending = ending_of(file);
  if (ending != ".png" && ending != ".dxf")
    return fail("--floor-plan: {} is no .png or .dxf; export one", file);
  if (ending == ".png" && !arguments.scale_m)
    return fail("--floor-plan: {} tells no scale; give --scale, metres per pixel", file);
  const auto outline =
      ending == ".png" ? read_floor_image(file, *arguments.scale_m) : read_dxf(file, arguments.scale_m);
  if (!outline) return tl::unexpected(outline.error());
  auto cloud = plan::extruded(*outline, *arguments.height_m);
  if (!cloud) return fail("{}: {}", file, cloud.error().message);
  return cloud;
}

/// Of a device.json, or of the first LiDAR of a site.json.
Result<Camera> read_camera(const std::string& file) {
  const auto object = read_json_object(file);
  if (!object) return tl::unexpected(object.error());
  if (!object->contains("global_lidars")) return JsonFields(*object, file).camera();
  const auto site = read_site(file);
  if (!site) return tl::unexpected(site.error());
  return site->global_lidars.front().camera;
}

Result<double> ceiling_of(const PlanArguments& arguments, const plan::FreeFloor& floor) {
  const bool given = !arguments.reference.empty() && arguments.height_m;
  if (!given && !floor.ceiling_z_m)
    return fail("{}: shows no ceiling; give --height, metres from floor to ceiling", arguments.reference);
  const double ceiling_z_m = given ? floor.floor_z_m + *arguments.height_m : *floor.ceiling_z_m;
  if (ceiling_z_m < floor.floor_z_m + kHeadroom_m)
    return fail("the ceiling is {:.2f} m above the floor, of at least {}; give --height",
                ceiling_z_m - floor.floor_z_m, kHeadroom_m);
  return ceiling_z_m;
}

Result<PlanInput> room_of(const PlanArguments& arguments) {
  const bool scanned = !arguments.reference.empty();
  const std::string& file = scanned ? arguments.reference : arguments.floor_plan;
  const auto cloud = scanned ? read_map_scan(file) : floor_plan_cloud(arguments);
  if (!cloud) return tl::unexpected(cloud.error());
  auto room = plan::VoxelRoom::create(*cloud);
  if (!room) return fail("{}: {}", file, room.error().message);
  auto floor = plan::find_free_floor(*room);
  if (!floor) return fail("{}: {}", file, floor.error().message);
  const auto ceiling_z_m = ceiling_of(arguments, *floor);
  if (!ceiling_z_m) return tl::unexpected(ceiling_z_m.error());
  return PlanInput{std::move(*room), std::move(*floor), *ceiling_z_m, {}, {}, {}};
}

}  // namespace

Result<PlanInput> read_plan_input(const PlanArguments& arguments) {
  Camera lidar = kL515, device = kL515;
  std::optional<Site> site;
  for (const auto& [file, camera] :
       {std::pair{&arguments.lidar_camera, &lidar}, {&arguments.device, &device}}) {
    if (file->empty()) continue;
    const auto read = read_camera(*file);
    if (!read) return tl::unexpected(read.error());
    *camera = *read;
  }
  if (!arguments.evaluate.empty()) {
    auto read = read_site(arguments.evaluate);
    if (!read) return tl::unexpected(read.error());
    if (read->global_lidars.size() > static_cast<std::size_t>(plan::kMostLidars))
      return fail("{}: has {} LiDARs, at most {} are planned for; evaluate a part of the site",
                  arguments.evaluate, read->global_lidars.size(), plan::kMostLidars);
    site = std::move(*read);
  }
  auto input = room_of(arguments);
  if (!input) return input;
  input->lidar = {lidar, arguments.lidar_range_m};
  input->device = {device, arguments.device_range_m, arguments.device_heights_m, plan::DeviceModel{}.down_rad};
  input->site = std::move(site);
  return input;
}

}  // namespace liloc::toolbox
