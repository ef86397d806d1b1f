#include "client/inertial/seen_and_felt.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

using Eigen::Vector3d;

constexpr double kRareSteps = 12;  // of which six tell a contradiction, ten that both agree; by hand
constexpr double kPieceS = 0.1;    // a device turns evenly for so long; by hand

}  // namespace

Vector3d mean(const std::vector<Vector3d>& values) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& v : values) sum += v;
  return sum / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

Fit fit(const Pairs& pairs, const Vector3d& seen_0, const Vector3d& felt_0, double least) {
  double ss = 0, sf = 0, ff = 0;
  for (std::size_t i = 0; i < pairs.seen.size(); ++i) {
    const Vector3d s = pairs.seen[i] - seen_0, f = pairs.felt[i] - felt_0;
    ss += s.squaredNorm();
    sf += s.dot(f);
    ff += f.squaredNorm();
  }
  if (ss < static_cast<double>(pairs.seen.size()) * least * least || ff <= 0 || sf == 0) return {};
  return {ff / sf, sf * std::abs(sf) / (ss * ff)};
}

StampNs window_ns(const MotionRecord& record, StampNs at_least) {
  return std::max(at_least, from_seconds(kRareSteps * record.seen().back().seconds()));
}

bool is_recent(const MotionRecord& record, const SeenStep& step, StampNs window_ns) {
  return record.seen().back().to_ns - step.to_ns < window_ns;
}

std::vector<FeltStep> felt_in_pieces(const MotionRecord& record, const SeenStep& step) {
  const int pieces = static_cast<int>(std::ceil(step.seconds() / kPieceS));
  std::vector<FeltStep> all;
  for (int i = 0; i < pieces; ++i) {
    const auto at = [&](int piece) { return step.from_ns + (step.to_ns - step.from_ns) * piece / pieces; };
    const auto felt = record.felt({at(i), at(i + 1)});
    if (!felt) return {};
    all.push_back(*felt);
  }
  return all;
}

}  // namespace liloc
