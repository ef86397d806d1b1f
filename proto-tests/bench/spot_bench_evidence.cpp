#include "proto-tests/bench/spot_bench_evidence.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace liloc::bench {
namespace {

bool right(const std::optional<Hypothesis>& hypothesis, const PoseEstimate& estimate, const Pose& truth) {
  return hypothesis && degrees(angle_between_rad(estimate.T_map_sensor, truth)) <= 10 &&
         distance_m(estimate.T_map_sensor, truth) <= 0.3;
}

std::string text_of(const std::optional<Hypothesis>& hypothesis, const PoseEstimate& estimate, bool is_right) {
  if (!hypothesis) return "0 0 0 0 0 0 0 0 0";
  const Judgement& j = hypothesis->judgement;
  return fmt::format("1 {:d} {:.5f} {:.5f} {:.5f} {:.5f} {:.5f} {:.6f} {:.6f}", is_right, j.agree, j.conflict,
                     j.map_agree, j.score, hypothesis->alignment.pair_share, estimate.sd_rad(),
                     estimate.sd_m());
}

bool read(std::istream& in, std::optional<Hypothesis>* hypothesis, PoseEstimate* estimate, bool* is_right) {
  Hypothesis h;
  bool present = false;
  double sd_rad = 0, sd_m = 0;
  Judgement& j = h.judgement;
  if (!(in >> present >> *is_right >> j.agree >> j.conflict >> j.map_agree >> j.score >>
        h.alignment.pair_share >> sd_rad >> sd_m))
    return false;
  if (present) *hypothesis = h;
  estimate->covariance.diagonal() << Eigen::Vector3d::Constant(sd_rad * sd_rad),
      Eigen::Vector3d::Constant(sd_m * sd_m);
  return true;
}

}  // namespace

EvidenceRow against_truth(const Evidence& evidence, const Pose& T_map_sensor_true) {
  EvidenceRow row;
  row.evidence = evidence;
  row.own_right = right(evidence.own, evidence.own_estimate, T_map_sensor_true);
  row.best_right = right(evidence.best, evidence.best_estimate, T_map_sensor_true);
  return row;
}

Status write_evidence(const std::string& path, const std::vector<EvidenceRow>& rows) {
  std::ofstream out(path);
  for (const EvidenceRow& r : rows)
    out << fmt::format("{} {:d} {:.4f} {} {} {:.5f} {:.4f} {:d} {:.4f} {}\n", r.seed, r.live, r.overlap,
                       text_of(r.evidence.own, r.evidence.own_estimate, r.own_right),
                       text_of(r.evidence.best, r.evidence.best_estimate, r.best_right), r.evidence.margin,
                       r.evidence.own_log_odds, r.evidence.stayed, r.evidence.log_odds, r.evidence.spots);
  if (!out.flush()) return fail("{}: cannot be written; name a file in a folder that exists", path);
  return {};
}

Result<std::vector<EvidenceRow>> read_evidence(const std::string& path) {
  std::ifstream in(path);
  if (!in) return fail("{}: cannot be read; write it with --evidence", path);
  std::vector<EvidenceRow> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    EvidenceRow r;
    const bool whole = fields >> r.seed >> r.live >> r.overlap &&
                       read(fields, &r.evidence.own, &r.evidence.own_estimate, &r.own_right) &&
                       read(fields, &r.evidence.best, &r.evidence.best_estimate, &r.best_right) &&
                       fields >> r.evidence.margin >> r.evidence.own_log_odds >> r.evidence.stayed >>
                           r.evidence.log_odds >> r.evidence.spots;
    if (!whole)
      return fail("{}: line {} is no row of evidence; write it with --evidence", path, rows.size() + 1);
    rows.push_back(std::move(r));
  }
  return rows;
}

}  // namespace liloc::bench
