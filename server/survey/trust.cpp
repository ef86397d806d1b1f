#include "server/survey/trust.hpp"

#include "common/geometry/pose_estimate.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/refine/pose_covariance.hpp"
#include "common/registration/refine/refine.hpp"

namespace liloc::survey {
namespace {

constexpr double kPaired_m = 0.05;   // a point on a surface, plane to point; by hand
constexpr float kSight_m = 0.03F;    // a conflict is twice that, and 2 % of the depth, before a surface
constexpr double kMedium_m = 0.08;   // one point in four: neighbours err alike
constexpr int kViewFactor = 2;       // rows and columns that one of the view stands for; by hand
constexpr double kFarthest_m = 8.5;  // as DepthOptions::max_range_m

}  // namespace

PoseEvidence evidence_of(const Target& rest, const LidarScan& scan, const Pose& T_map_sensor) {
  PoseEvidence evidence;
  const Fit fit = fit_of(rest, scan.cloud, T_map_sensor, kPaired_m);
  evidence.overlap = fit.fitness;
  const SightView view =
      SightView::from_depth(scan.surfaces, scan.lidar.camera, T_map_sensor.inverse(), kViewFactor, kFarthest_m);
  int conflict = 0;
  for (const Eigen::Vector3f& p_map : rest->coarse.points) {
    const Sight sight = view.look(p_map, kSight_m);
    conflict += sight == Sight::conflict;
    evidence.seen += sight == Sight::conflict || sight == Sight::agrees;
  }
  evidence.conflict = evidence.seen > 0 ? conflict / static_cast<double>(evidence.seen) : 0;
  Query query;
  query.cloud = scan.cloud;
  query.medium = voxel_downsample(scan.cloud, kMedium_m);
  const PoseEstimate pose{T_map_sensor, pose_covariance(rest, query, T_map_sensor)};
  evidence.sd_rad = pose.sd_rad();
  evidence.sd_m = pose.sd_m();
  return evidence;
}

std::string doubt_of(const PoseEvidence& evidence, const TrustOptions& options) {
  if (evidence.overlap < options.least_overlap)
    return fmt::format("{:.0f} % of its view is found in the rest of the room; start nearer, or scan anew",
                       100 * evidence.overlap);
  if (evidence.conflict > options.most_conflict)
    return fmt::format(
        "it looks through {:.0f} % of what it should see; a wrong place, or the room has changed",
        100 * evidence.conflict);
  if (evidence.residual_m > options.most_residual_m)
    return fmt::format("its surfaces lie {:.1f} cm beside the rest; check intrinsics and depth_scale",
                       100 * evidence.residual_m);
  if (evidence.sd_m > options.most_sd_m || evidence.sd_rad > options.most_sd_rad)
    return fmt::format("what it sees leaves {:.1f} cm and {:.2f} deg open; tilt it so that it sees walls",
                       100 * evidence.sd_m, degrees(evidence.sd_rad));
  return {};
}

}  // namespace liloc::survey
