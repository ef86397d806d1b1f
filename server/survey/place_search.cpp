#include "server/survey/place_search.hpp"

#include <algorithm>

#include "common/registration/search/candidate.hpp"
#include "common/registration/spot/align.hpp"
#include "server/survey/joint_refine.hpp"
#include "server/survey/trust.hpp"

namespace liloc::survey {
namespace {

constexpr double kSearchVoxel_m = 0.05;  // what AlignOptions' figures are measured at
constexpr std::size_t kTried = 10;       // hypotheses that are refined and judged
constexpr double kTwinMargin = 0.06;     // of the score below: what furniture that was moved can make
constexpr double kConflictWeight = 2;    // looked through: moved furniture at most; overlap: chance as well

struct Scored {
  Pose T_map_sensor;
  double score;
};

/// A place refined against the scan alone, and judged by overlap and free space.
Scored judged(const LidarScan& scan, const Reference& reference, const Pose& T_map_sensor_guess) {
  std::vector<JointLidar> alone(1);
  alone[0].cloud = &scan.cloud;
  alone[0].T_map_sensor = T_map_sensor_guess;
  refine_together(&reference, &alone, {});
  const Pose& T = alone[0].T_map_sensor;
  const Target room = make_target(reference.facing(T.translation().cast<float>()), {}, kSearchVoxel_m);
  const PoseEvidence evidence = evidence_of(room, scan, T);
  return {T, evidence.overlap - kConflictWeight * evidence.conflict};
}

AlignOptions align_options(std::uint64_t seed) {
  AlignOptions options;
  options.voxel_size_m = kSearchVoxel_m;
  options.seed = seed;
  return options;
}

}  // namespace

std::optional<FoundPlace> find_in_scan(const LidarScan& scan, const Reference& reference, std::uint64_t seed) {
  // From its middle a scan of a room is seen as from a sensor inside: so that most normals face the air.
  const Eigen::Vector3d middle = reference.middle_map().cast<double>();
  Pose T_map_middle = Pose::Identity();
  T_map_middle.translation() = middle;
  const auto hypotheses = align_hypotheses(
      scan.cloud, transformed(T_map_middle.inverse(), reference.cloud_map()), align_options(seed));
  if (!hypotheses) return std::nullopt;
  std::vector<Scored> places;
  for (const AlignHypothesis& h : *hypotheses) {
    if (places.size() == kTried) break;
    places.push_back(judged(scan, reference, T_map_middle * h.alignment.T_target_source));
  }
  if (places.empty()) return std::nullopt;
  std::ranges::stable_sort(places, std::greater{}, &Scored::score);
  const bool twin = std::ranges::any_of(places, [&](const Scored& p) {
    return p.score > places[0].score - kTwinMargin && !same_place(p.T_map_sensor, places[0].T_map_sensor);
  });
  return FoundPlace{places[0].T_map_sensor, twin};
}

std::vector<std::optional<FoundPlace>> find_by_overlap(const std::vector<LidarScan>& scans,
                                                       const std::vector<bool>& search, std::uint64_t seed) {
  struct Link {
    std::size_t from, to;
    Pose T_to_from;
    double confidence;
    bool trusted;
  };
  std::vector<Link> links;
  for (std::size_t from = 0; from < scans.size(); ++from)
    for (std::size_t to = 0; to < scans.size(); ++to) {
      if (!search[from] || from == to) continue;
      const auto result = align_clouds(scans[from].cloud, scans[to].cloud, align_options(seed));
      if (result) links.push_back({from, to, result->T_target_source, result->confidence, result->trusted});
    }
  std::ranges::stable_sort(links, std::greater{}, &Link::confidence);
  std::vector<std::optional<FoundPlace>> found(scans.size());
  const auto placed = [&](std::size_t i) { return !search[i] || found[i]; };
  while (true) {
    const auto link =
        std::ranges::find_if(links, [&](const Link& l) { return !placed(l.from) && placed(l.to); });
    if (link == links.end()) return found;
    const Pose& T_map_to =
        search[link->to] ? found[link->to]->T_map_sensor : scans[link->to].lidar.T_map_sensor;
    found[link->from] = FoundPlace{T_map_to * link->T_to_from, !link->trusted};
  }
}

}  // namespace liloc::survey
