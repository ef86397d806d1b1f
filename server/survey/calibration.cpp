#include "server/survey/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/geometry/pose_estimate.hpp"
#include "server/survey/place_search.hpp"

namespace liloc::survey {
namespace {

// 3 deg of a wall at 6 m are 0.3 m, which is how far a reference's index reaches.
constexpr double kGuessDistance_m = 0.30;
constexpr int kGuessIterations = 40;  // by hand
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

/// All that is known of the room but for LiDAR `i`, by the scan or by LiDARs that are not left out.
Target rest_of(std::size_t i, const std::vector<LidarScan>& scans, const std::vector<JointLidar>& lidars,
               const Reference* reference) {
  Cloud rest_map;
  if (reference != nullptr) rest_map = reference->facing(lidars[i].T_map_sensor.translation().cast<float>());
  for (std::size_t j = 0; j < scans.size() && reference == nullptr; ++j)
    if (j != i && !lidars[j].left_out) append(rest_map, transformed(lidars[j].T_map_sensor, scans[j].cloud));
  return make_target(rest_map, {}, kVoxel_m);
}

/// `lidars` as refined for their poses, `with_errors` the same with their depths' errors.
CalibratedLidar result_of(std::size_t i, const std::vector<LidarScan>& scans,
                          const std::vector<JointLidar>& lidars, const std::vector<JointLidar>& with_errors,
                          const Reference* reference) {
  CalibratedLidar result;
  const Pose& T_guess = scans[i].lidar.T_map_sensor;
  result.T_map_sensor = normalized(lidars[i].T_map_sensor);
  result.moved_m = distance_m(T_guess, result.T_map_sensor);
  result.moved_rad = angle_between_rad(T_guess, result.T_map_sensor);
  result.error = with_errors[i].error;
  result.error_sd = with_errors[i].error_sd;
  PoseEvidence& evidence = result.evidence;
  evidence = evidence_of(rest_of(i, scans, lidars, reference), scans[i], result.T_map_sensor);
  evidence.residual_m = lidars[i].residual_m;
  const PoseEstimate whatever_depths{result.T_map_sensor, with_errors[i].covariance};
  evidence.sd_m = std::max(evidence.sd_m, whatever_depths.sd_m());
  evidence.sd_rad = std::max(evidence.sd_rad, whatever_depths.sd_rad());
  TrustOptions trust;
  if (reference == nullptr) trust.least_overlap = kLeastOverlapWithout;
  result.doubt = doubt_of(evidence, trust);
  return result;
}

/// Refines, and judges whom to trust. A LiDAR whose place is in doubt must not lead others astray: they are
/// refined anew without it, until no further one is doubted. `results` holds what is thought of each before.
void decide_trust(const std::vector<LidarScan>& scans, const Reference* reference, const Places& places,
                  const JointOptions& joint, std::vector<JointLidar>* lidars,
                  std::vector<CalibratedLidar>* results) {
  const auto fewest = reference == nullptr ? 2 : 1;
  const std::vector<JointLidar> start = *lidars;
  bool doubted = true;
  while (doubted && std::ranges::count(*lidars, false, &JointLidar::left_out) >= fewest) {
    for (std::size_t i = 0; i < scans.size(); ++i) (*lidars)[i].T_map_sensor = start[i].T_map_sensor;
    refine_together(reference, lidars, joint);
    JointOptions whatever_depths = joint;
    whatever_depths.start_distance_m = joint.end_distance_m;
    whatever_depths.depth_errors = true;
    std::vector<JointLidar> with_errors = *lidars;
    refine_together(reference, &with_errors, whatever_depths);
    for (std::size_t i = 0; i < scans.size(); ++i)
      if (!(*lidars)[i].left_out) (*results)[i] = result_of(i, scans, *lidars, with_errors, reference);
    doubted = false;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      CalibratedLidar& result = (*results)[i];
      if (places[i] && places[i]->twin && result.trusted())
        result.doubt = "another place fits almost as well; give a rough one with --near";
      if (reference == nullptr && result.trusted() && !results->front().trusted())
        result.doubt = "the first LiDAR, which holds the others, is in doubt";
      doubted |= !result.trusted() && !(*lidars)[i].left_out;
      (*lidars)[i].left_out = !result.trusted();
    }
  }
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
  std::vector<CalibratedLidar> results(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    lidars[i].cloud = &scans[i].cloud;
    lidars[i].T_map_sensor = places[i] ? places[i]->T_map_sensor : scans[i].lidar.T_map_sensor;
    lidars[i].fixed = reference == nullptr && i == 0;
    results[i].T_map_sensor = lidars[i].T_map_sensor;
    results[i].doubt = "no other LiDAR has a place to judge it by; give rough ones with --near";
    if (!options.search[i] || lidars[i].fixed || places[i]) continue;
    lidars[i].left_out = true;  // where the site has it is no guess
    results[i].doubt = "no place is found for it; give a rough one with --near";
  }
  JointOptions joint;
  joint.start_distance_m = kGuessDistance_m;
  joint.iterations = kGuessIterations;
  joint.voxel_size_m = kVoxel_m;
  decide_trust(scans, reference, places, joint, &lidars, &results);
  return results;
}

}  // namespace liloc::survey
