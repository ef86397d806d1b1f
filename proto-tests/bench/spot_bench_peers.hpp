#pragma once
// Other libraries' FPFH and RANSAC on the same clouds, with the same normals.
#include <string>
#include <vector>

#include "common/geometry/cloud.hpp"

namespace liloc::bench {

/// A cloud to be found in another. Both thinned and with normals.
struct PeerProblem {
  Cloud source, target;
  Pose T_target_source_true = Pose::Identity();
  double overlap = 0;
  std::size_t row = 0;  ///< of our own answer to it
};

struct PeerAnswer {
  Pose T_target_source = Pose::Identity();
  double latency_ms = 0;         ///< features of the source, matching, refinement
  double target_latency_ms = 0;  ///< features of the target, which a server could keep
};

/// FPFH, SampleConsensusPrerejective, point-to-plane ICP.
[[nodiscard]] PeerAnswer ask_pcl(const PeerProblem& problem, int threads);

/// FPFH, RANSAC on feature matches, point-to-plane ICP: Open3D by the script open3d_peer.py, through files.
/// Errors: no python3 with Open3D (deploy/install --peers brings it), the script failed.
[[nodiscard]] Result<std::vector<PeerAnswer>> ask_open3d(const std::vector<PeerProblem>& problems, int threads);

}  // namespace liloc::bench
