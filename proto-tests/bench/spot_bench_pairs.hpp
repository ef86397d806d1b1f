#pragma once
#include "proto-tests/bench/spot_bench_peers.hpp"

namespace liloc::bench {

struct PairsOptions {
  std::string folder;
  int threads = 1;
  int peer_every = 0;  ///< ask PCL and Open3D for every so many pairs; 0: never
};

/// Aligns the pairs of FOLDER/gt.log (`i j n`, then the 4x4 that maps cloud_bin_j.ply into cloud_bin_i.ply) and
/// prints how many are solved: 0.2 m RMSE over the points that truly overlap. Errors: a file is missing or no
/// such file.
[[nodiscard]] Status run_pairs(const PairsOptions& options);

}  // namespace liloc::bench
