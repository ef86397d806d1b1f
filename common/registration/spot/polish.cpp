#include "common/registration/spot/polish.hpp"

#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

namespace liloc {
namespace {

constexpr float kMargin_m = 0.8F;   // how far a climb may carry a surface into view; by hand
constexpr std::size_t kStride = 2;  // as if half of the points were asked; by hand

/// The score of poses near a guess, by few points.
class Scorer {
 public:
  Scorer(const SpotProblem& problem, const Pose& T_map_sensor_guess) : problem_(problem) {
    const Eigen::Isometry3f T_sensor_map = T_map_sensor_guess.inverse().cast<float>();
    const Target& target = problem.target;
    std::vector<Eigen::Vector3f> sound, stale;
    for (std::size_t i = 0; i < target->coarse.size(); i += kStride) {
      const Eigen::Vector3f& p = target->coarse.points[i];
      if (!problem.query.view.may_see(T_sensor_map * p, kMargin_m)) continue;
      (target.dynamic && target.dynamic->stale[i] != 0 ? stale : sound).push_back(p);
    }
    near_.emplace(sound, stale, MapOrder::as_given);
  }

  [[nodiscard]] double operator()(const Pose& T_map_sensor) const {
    const JudgeOptions& options = problem_.judging;
    return judge(problem_.target, problem_.query, problem_.query.sparse, T_map_sensor,
                 options.sketch_tolerance_m, MapShare::half, options.sketch_conflict_weight, &*near_)
        .score;
  }

 private:
  const SpotProblem& problem_;
  std::optional<MapPoints> near_;
};

/// A step along one of the map's axes, or about it.
Pose stepped(const Pose& T_map_sensor, int axis, double shift_m, double turn_rad) {
  Pose T = T_map_sensor;
  if (axis < 3)
    T.translation()[axis] += shift_m;
  else
    T.linear() =
        Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::Unit(axis - 3)).toRotationMatrix() * T_map_sensor.linear();
  return T;
}

/// Steps along each axis once, where that is uphill.
bool improve(const Scorer& score, double shift_m, double turn_rad, Pose* T, double* best) {
  bool improved = false;
  for (int axis = 0; axis < 6; ++axis)
    for (const double sign : {1.0, -1.0}) {
      const Pose next = stepped(*T, axis, sign * shift_m, sign * turn_rad);
      const double value = score(next);
      if (value <= *best) continue;
      *best = value;
      *T = next;
      improved = true;
      break;
    }
  return improved;
}

Pose climbed(const SpotProblem& problem, Pose T, const PolishOptions& options) {
  const Scorer score(problem, T);
  double best = score(T), shift_m = options.shift_m, turn_rad = options.turn_rad;
  for (int halving = 0; halving <= options.halvings; ++halving, shift_m /= 2, turn_rad /= 2)
    for (int round = 0; round < options.rounds && improve(score, shift_m, turn_rad, &T, &best); ++round) {
    }
  T.linear() = normalized(T).linear();
  return T;
}

}  // namespace

bool is_clean(const Hypothesis& hypothesis, const PolishOptions& options) {
  const Judgement& j = hypothesis.judgement;
  return j.agree >= options.clean_agree && j.overlap() >= options.clean && j.map_agree >= options.clean;
}

Hypothesis polish(const SpotProblem& problem, const Pose& T_map_sensor_guess, Hypothesis refined,
                  const PolishOptions& options) {
  SpotProblem held = problem, free = problem;
  held.judging.refine.hold = options.hold;
  free.judging.refine.sparse_iterations = 0;
  Hypothesis polished = refine_and_judge(held, climbed(problem, T_map_sensor_guess, options));
  Hypothesis freed = refine_and_judge(free, polished.T_map_sensor());
  if (freed.judgement.score > polished.judgement.score - options.as_good) polished = std::move(freed);
  return polished.judgement.score > refined.judgement.score + options.as_good ? polished : refined;
}

}  // namespace liloc
