#include "proto-tests/bench/spot_bench_evidence.hpp"

#include <fmt/format.h>

#include <fstream>

namespace liloc::bench {

std::vector<bool> against_truth(const Evidence& evidence, const Pose& T_map_sensor_true) {
  std::vector<bool> right;
  for (const Pose& T : evidence.T_map_sensors)
    right.push_back(degrees(angle_between_rad(T, T_map_sensor_true)) <= 10 &&
                    distance_m(T, T_map_sensor_true) <= 0.3);
  return right;
}

Status write_evidence(const std::string& path, const std::vector<EvidenceRow>& rows) {
  std::ofstream out(path);
  out << "site,seed,client,cold,t_s,overlap,spot,place,right,agreeing,searches,support,contradiction,excess,"
         "misfit,bits,sd_m\n";
  for (std::size_t spot = 0; spot < rows.size(); ++spot) {
    const EvidenceRow& r = rows[spot];
    for (std::size_t i = 0; i < r.evidence.places.size(); ++i) {
      const PlaceEvidence& p = r.evidence.places[i];
      out << fmt::format(
          "\"{}\",{},{},{:d},{:.2f},{:.3f},{},{},{:d},{:.0f},{:.0f},{:.5f},{:.5f},{:.6f},{:.4f},{:.3f},{:.6f}"
          "\n",
          r.site, r.seed, r.client, r.cold, r.t_s, r.overlap, spot, i, r.right[i] ? 1 : 0, p.agreeing,
          p.searches, p.looks.support, p.looks.contradiction, p.looks.excess, p.looks.misfit, p.bits, p.sd_m);
    }
  }
  if (!out.flush()) return fail("{}: cannot be written; name a file in a folder that exists", path);
  return {};
}

}  // namespace liloc::bench
