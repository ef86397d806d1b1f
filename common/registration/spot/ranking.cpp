#include "common/registration/spot/ranking.hpp"

#include <cmath>

namespace liloc {
namespace {

constexpr double kFewBits = 3;  // below which places are told apart no better; by hand

}  // namespace

double standing_of(const Judgement& judgement, double bits, const Ranking& ranking) {
  const double conflict = judgement.conflict + judgement.map_conflict * judgement.map_seen;
  return ranking.log_bits * std::log(bits + kFewBits) -
         ranking.log_conflict * std::log1p(conflict / ranking.few_conflicts) +
         ranking.agreement * (judgement.agree + judgement.map_agree * judgement.map_seen);
}

}  // namespace liloc
