#include "server/survey/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "server/survey/place_search.hpp"

namespace liloc::survey {
namespace {

// 3 deg of a wall at 6 m are 0.3 m, which is how far a reference's index reaches.
constexpr double kGuessDistance_m = 0.30;
constexpr int kGuessIterations = 40;
// Without a scan the rest of the room is what other ceiling LiDARs see: a small part of the view suffices.
constexpr double kLeastOverlapWithout = 0.08;

using Places = std::vector<std::optional<FoundPlace>>;

Places found_places(const std::vector<LidarScan>& scans, const Reference* reference,
                    const CalibrationOptions& options) {
  std::vector<bool> search = options.search;
  if (reference == nullptr) {
    search[0] = false;
    return find_by_overlap(scans, search, options.seed);
  }
  Places places(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (search[i]) places[i] = find_in_scan(scans[i], *reference, options.seed);
  return places;
}

/// All that is known of the room but for LiDAR `i`.
Target rest_of(std::size_t i, const std::vector<LidarScan>& scans, const std::vector<JointLidar>& lidars,
               const Reference* reference) {
  Cloud rest_map;
  if (reference != nullptr) rest_map = reference->facing(lidars[i].T_map_sensor.translation().cast<float>());
  for (std::size_t j = 0; j < scans.size() && reference == nullptr; ++j)
    if (j != i) append(rest_map, transformed(lidars[j].T_map_sensor, scans[j].cloud));
  return make_target(rest_map, {}, kVoxel_m);
}

CalibratedLidar result_of(std::size_t i, const std::vector<LidarScan>& scans,
                          const std::vector<JointLidar>& lidars, const Reference* reference) {
  CalibratedLidar result;
  const Pose& T_guess = scans[i].lidar.T_map_sensor;
  result.T_map_sensor = normalized(lidars[i].T_map_sensor);
  result.moved_m = distance_m(T_guess, result.T_map_sensor);
  result.moved_rad = angle_between_rad(T_guess, result.T_map_sensor);
  result.evidence = evidence_of(rest_of(i, scans, lidars, reference), scans[i], result.T_map_sensor);
  result.evidence.residual_m = lidars[i].residual_m;
  TrustOptions trust;
  if (reference == nullptr) trust.least_overlap = kLeastOverlapWithout;
  result.doubt = doubt_of(result.evidence, trust);
  return result;
}

Status check(const std::vector<LidarScan>& scans, const Reference* reference,
             const CalibrationOptions& options) {
  if (scans.empty()) return fail("no LiDAR to calibrate");
  if (options.search.size() != scans.size())
    return fail("{} LiDARs, but {} told to be searched or not", scans.size(), options.search.size());
  if (scans.size() == 1 && reference == nullptr)
    return fail("one LiDAR alone cannot be calibrated; give a scan of the room");
  return {};
}

}  // namespace

Result<std::vector<CalibratedLidar>> calibrate(const std::vector<LidarScan>& scans, const Reference* reference,
                                               const CalibrationOptions& options) {
  if (const Status status = check(scans, reference, options); !status) return tl::unexpected(status.error());
  const Places places = found_places(scans, reference, options);
  std::vector<JointLidar> lidars(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    lidars[i].cloud = &scans[i].cloud;
    lidars[i].T_map_sensor = places[i] ? places[i]->T_map_sensor : scans[i].lidar.T_map_sensor;
    lidars[i].fixed = reference == nullptr && i == 0;
  }
  JointOptions joint;
  joint.start_distance_m = kGuessDistance_m;
  joint.iterations = kGuessIterations;
  joint.voxel_size_m = kVoxel_m;
  refine_together(reference, &lidars, joint);
  std::vector<JointLidar> with_errors = lidars;
  joint.start_distance_m = joint.end_distance_m;
  joint.depth_errors = true;
  refine_together(reference, &with_errors, joint);
  std::vector<CalibratedLidar> results;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    CalibratedLidar result = result_of(i, scans, lidars, reference);
    result.error = with_errors[i].error;
    result.error_sd = with_errors[i].error_sd;
    const bool searched = options.search[i] && !lidars[i].fixed;
    if (searched && !places[i])
      result.doubt = "no place is found for it; give a rough one with --near";
    else if (searched && places[i]->twin && result.trusted())
      result.doubt = "another place fits almost as well; give a rough one with --near";
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace liloc::survey
