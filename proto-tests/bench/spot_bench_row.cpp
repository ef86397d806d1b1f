#include "proto-tests/bench/spot_bench_row.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <ctime>
#include <fstream>

namespace liloc::bench {

double thread_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

Row judged(SpotReply reply, const Pose& T_map_sensor_true) {
  Row row;
  row.reply = std::move(reply);
  if (!row.reply.T_map_sensor) return row;
  const Pose& T = *row.reply.T_map_sensor;
  row.error_deg = degrees(angle_between_rad(T, T_map_sensor_true));
  row.error_m = distance_m(T, T_map_sensor_true);
  const Eigen::Matrix3d R = T_map_sensor_true.linear().transpose();
  row.error << so3_log(R * T.linear()), R * (T.translation() - T_map_sensor_true.translation());
  row.nees = row.error.dot(row.reply.covariance.ldlt().solve(row.error));
  return row;
}

Status write_csv(const std::string& path, const std::vector<Row>& rows) {
  std::ofstream out(path);
  out << "site,seed,client,seq,cold,overlap_truth,error_deg,error_m,status,reason,fitness,overlap,margin,"
         "latency_ms,cpu_ms,prepare_ms,nees,ex_rad,ey_rad,ez_rad,ex_m,ey_m,ez_m,sx_rad,sy_rad,sz_rad,sx_m,sy_m,"
         "sz_m,conflict_truth,map_conflict_truth,miss,confidence,advice,text\n";
  for (const Row& r : rows) {
    const Vector6d sd = r.reply.covariance.diagonal().cwiseMax(0).cwiseSqrt();
    out << fmt::format(
        "\"{}\",{},{},{},{},{:.3f},{:.2f},{:.4f},{},{},{:.3f},{:.3f},{:.3f},{:.1f},{:.1f},{:.1f},{:.2f},",
        r.site, r.seed, r.reply.client_id, r.reply.seq, r.cold ? 1 : 0, r.overlap, r.error_deg, r.error_m,
        name_of(r.reply.status), name_of(r.reply.reason), r.reply.fitness, r.reply.overlap, r.reply.margin,
        r.reply.latency_ms, r.cpu_ms, r.prepare_ms, r.nees);
    for (const Vector6d& numbers : {r.error, sd})
      out << fmt::format("{:.6f},", fmt::join(numbers.begin(), numbers.end(), ","));
    out << fmt::format("{:.5f},{:.5f},{},{:.6f},{},\"{}\"\n", r.conflict_truth, r.map_conflict_truth,
                       static_cast<int>(r.miss), r.reply.confidence, name_of(r.reply.advice), r.reply.text);
  }
  if (!out.flush()) return fail("{}: cannot be written; name a file in a folder that exists", path);
  return {};
}

}  // namespace liloc::bench
