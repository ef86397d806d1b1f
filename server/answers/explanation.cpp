#include "server/answers/explanation.hpp"

#include <algorithm>

namespace liloc::answers {
namespace {

template <class T>
void compare(std::string_view what, const T& saved, const T& again, std::vector<std::string>* differences) {
  if (saved != again) differences->push_back(fmt::format("{}: {} was saved, {} now", what, saved, again));
}

void compare_poses(std::string_view what, const std::optional<Pose>& saved, const std::optional<Pose>& again,
                   std::vector<std::string>* differences) {
  if (saved.has_value() != again.has_value())
    return differences->push_back(fmt::format("{}: {} now", what, again ? "there" : "missing"));
  if (saved && saved->matrix() != again->matrix())
    differences->push_back(fmt::format("{}: {:.3g} m and {:.3g} deg away", what, distance_m(*saved, *again),
                                       degrees(angle_between_rad(*saved, *again))));
}

std::vector<std::string> differences_of(const SpotReply& saved, const SpotReply& again) {
  std::vector<std::string> all;
  compare("status", name_of(saved.status), name_of(again.status), &all);
  compare("reason", name_of(saved.reason), name_of(again.reason), &all);
  compare("advice", name_of(saved.advice), name_of(again.advice), &all);
  compare("text", saved.text, again.text, &all);
  compare_poses("T_map_sensor", saved.T_map_sensor, again.T_map_sensor, &all);
  compare_poses("T_map_odom", saved.T_map_odom, again.T_map_odom, &all);
  if (saved.covariance != again.covariance) all.emplace_back("covariance: another");
  compare("fitness", saved.fitness, again.fitness, &all);
  compare("inlier_rmse_m", saved.inlier_rmse_m, again.inlier_rmse_m, &all);
  compare("overlap", saved.overlap, again.overlap, &all);
  compare("margin", saved.margin, again.margin, &all);
  compare("confidence", saved.confidence, again.confidence, &all);
  compare("gpc_stamp_ns", saved.gpc_stamp_ns, again.gpc_stamp_ns, &all);
  return all;
}

Word word_of(bool agrees, bool conflict) {
  return agrees ? Word::agrees : conflict ? Word::contradicts : Word::missing;
}

/// As the judge does: agreement of one ceiling LiDAR outweighs all others, and beside somebody who moves
/// looking through says nothing.
Word ceiling_word(const Target& target, const Eigen::Vector3f& p_map, float tolerance_m) {
  bool agrees = false, conflict = false;
  for (const SightView& view : target.views) {
    const Sight sight = view.look(p_map, tolerance_m);
    agrees |= sight == Sight::agrees;
    conflict |= sight == Sight::conflict;
  }
  return word_of(agrees, conflict && (target.dynamic_mask() == nullptr || !target.dynamic_mask()->at(p_map)));
}

void mark(const Spot& spot, Explanation* explanation) {
  const SpotProblem& problem = spot.problem();
  const auto tolerance_m = static_cast<float>(problem.judging.fine_tolerance_m);
  const Eigen::Isometry3f T = explanation->T_map_sensor->cast<float>(), T_sensor_map = T.inverse();
  for (const Eigen::Vector3f& p : spot.query().medium.points)
    explanation->device.push_back({T * p, ceiling_word(problem.target, T * p, tolerance_m)});
  for (const Eigen::Vector3f& p_map : problem.target->coarse.points) {
    const Sight sight = spot.query().view.look_sensor(T_sensor_map * p_map, tolerance_m);
    if (sight == Sight::agrees || sight == Sight::conflict)
      explanation->ceiling.push_back({p_map, word_of(sight == Sight::agrees, sight == Sight::conflict)});
  }
}

}  // namespace

Explanation explain(const SavedAnswer& saved) {
  Explanation explanation;
  explanation.again = run_again(saved.answered);
  const Rerun& again = explanation.again;
  explanation.differences = differences_of(saved.answered.reply, again.answer.reply);
  explanation.T_map_sensor = again.answer.reply.T_map_sensor;
  if (!explanation.T_map_sensor && !again.answer.evidence.T_map_sensors.empty())
    explanation.T_map_sensor = again.answer.evidence.T_map_sensors.front();
  if (!again.spot || !explanation.T_map_sensor) return explanation;
  const SpotProblem& problem = again.spot->problem();
  explanation.judgement = judge(problem.target, problem.query, problem.query.medium, *explanation.T_map_sensor,
                                problem.judging.fine_tolerance_m);
  mark(*again.spot, &explanation);
  return explanation;
}

}  // namespace liloc::answers
