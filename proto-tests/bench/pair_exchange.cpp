#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "proto-tests/bench/pair_bench.hpp"
#include "proto-tests/sim/write_recording.hpp"

namespace liloc::bench {

Status dump_pairs(const std::vector<FramePair>& pairs, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::ofstream table(folder / "pairs.csv");
  if (!table) return fail("{}: cannot be written; name a folder of your own", (folder / "pairs.csv").string());
  table << "pair,gap,tx,ty,tz,qx,qy,qz,qw\n";
  for (const FramePair& pair : pairs) {
    if (auto ok = sim::write_ply(folder / (pair.name + ".target.ply"), pair.target->cloud_sensor); !ok)
      return ok;
    if (auto ok = sim::write_ply(folder / (pair.name + ".source.ply"), pair.source->cloud_sensor); !ok)
      return ok;
    const Eigen::Vector3d t = pair.T_target_source_guess.translation();
    const Eigen::Quaterniond q(pair.T_target_source_guess.linear());
    table << fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", pair.name, pair.gap, t.x(),
                         t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  }
  return {};
}

Result<std::vector<PairResult>> read_peer(const std::vector<FramePair>& pairs,
                                          const std::filesystem::path& file) {
  std::map<std::string, const FramePair*> by_name;
  for (const FramePair& pair : pairs) by_name[pair.name] = &pair;
  std::ifstream table(file);
  std::string line;
  if (!std::getline(table, line))
    return fail("{}: cannot be read; give the CSV that the peer wrote", file.string());
  std::vector<PairResult> results;
  for (int number = 2; std::getline(table, line); ++number) {
    std::istringstream row(line);
    std::string name, method, rest;
    std::getline(row, name, ',');
    std::getline(row, method, ',');
    std::getline(row, rest);
    std::replace(rest.begin(), rest.end(), ',', ' ');
    std::istringstream numbers(rest);
    double tx = 0, ty = 0, tz = 0, qx = 0, qy = 0, qz = 0, qw = 0, ms = 0;
    if (!(numbers >> tx >> ty >> tz >> qx >> qy >> qz >> qw >> ms))
      return fail("{}, line {}: '{}'; must be pair,method,tx,ty,tz,qx,qy,qz,qw,latency_ms", file.string(),
                  number, line);
    const auto T = valid_pose({tx, ty, tz}, {qx, qy, qz, qw}, name);
    if (!T) return tl::unexpected(T.error());
    const auto found = by_name.find(name);
    if (found == by_name.end()) continue;
    const Pose truth = found->second->truth();
    results.push_back({method, found->second->gap, distance_m(*T, truth), angle_between_rad(*T, truth), ms,
                       found->second->overlap});
  }
  return results;
}

}  // namespace liloc::bench
