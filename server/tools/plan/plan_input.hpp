#pragma once
// What `liloc plan` is given, read and checked.
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/camera.hpp"
#include "server/plan/device_views.hpp"
#include "server/plan/placement.hpp"

namespace liloc::toolbox {

struct PlanArguments {
  std::string reference, floor_plan, evaluate, out, lidar_camera, device;
  std::optional<double> scale_m, height_m;
  std::optional<int> lidars;
  std::vector<double> device_heights_m = plan::DeviceModel{}.heights_m;
  double lidar_range_m = plan::kLidarRange_m, device_range_m = plan::DeviceModel{}.range_m, rate_hz = 6;
  std::uint64_t seed = 1;
  bool study = false, json = false;
};

struct PlanInput {
  plan::VoxelRoom room;
  plan::FreeFloor floor;
  double ceiling_z_m = 0;  ///< of the map
  plan::DeviceModel device;
  plan::LidarModel lidar;
  std::optional<Site> site;  ///< to evaluate
};

/// Errors name the option or file and the remedy.
[[nodiscard]] Result<PlanInput> read_plan_input(const PlanArguments& arguments);

}  // namespace liloc::toolbox
