#include "server/localization/belief.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

double square(double x) {
  return x * x;
}

}  // namespace

bool is_somewhere(const Judgement& judgement, const BeliefOptions& options) {
  return judgement.agree >= options.somewhere;
}

double evidence_of(const Judgement& judgement, bool fits, const BeliefOptions& options) {
  const double conflict = judgement.conflict + judgement.map_conflict * judgement.map_seen;
  return -options.unseen * std::log(1.0 + options.least_unseen - judgement.agree) -
         options.conflict * std::log1p(conflict / options.few_conflict) -
         options.beyond * std::max(0.0, conflict - options.much_conflict) - (fits ? 0.0 : options.unfit);
}

std::vector<double> weights_of(const std::vector<Pose>& T_odom_sensors, const BeliefOptions& options) {
  std::vector<double> weights;
  double sum = 0;
  for (const Pose& spot : T_odom_sensors) {
    double alike = 0;
    for (const Pose& other : T_odom_sensors)
      alike += std::exp(-square(distance_m(spot, other) / options.view.distance_m) -
                        square(angle_between_rad(spot, other) / options.view.angle_rad));
    weights.push_back(1 / alike);
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

double log_odds_of(std::size_t place, const std::vector<double>& evidence, const BeliefOptions& options) {
  double against = std::exp(options.elsewhere - evidence[place]);
  for (std::size_t i = 0; i < evidence.size(); ++i)
    if (i != place) against += std::exp(evidence[i] - evidence[place]);
  return -std::log(against);
}

}  // namespace liloc
