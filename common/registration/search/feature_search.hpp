#pragma once
#include <optional>
#include <vector>

#include "common/registration/features/fpfh.hpp"
#include "common/registration/search/feature_samples.hpp"
#include "common/registration/target/target.hpp"

namespace liloc {

/// What a cloud needs for matching by features: its thinned points and their descriptors. Clouds that are
/// matched are described in the same way.
struct Described {
  Cloud cloud;
  Features features;
};

/// Defaults are by hand where nothing else is said.
struct DescribeOptions {
  double feature_radius_m = 0.5;  ///< five times the spacing of the thinned cloud
  double sampling = 0.5;          ///< share of the points that are described (paper, section 5.2)
  std::uint64_t seed = 1;
  std::size_t most = 100'000;  ///< about so many are described at most: matching costs their product
  Describer describer = {};    ///< empty: FPFH
  /// What is up in the cloud's frame, where it is known: a describer sees the cloud turned to have z up.
  std::optional<Eigen::Vector3d> up = std::nullopt;
};
/// `dense`: the cloud that was thinned, for a describer that sees more in it; null: there is none.
[[nodiscard]] Described describe(const Cloud& thinned, const DescribeOptions& options,
                                 const Cloud* dense = nullptr);

/// Defaults are by hand where nothing else is said.
struct FeatureSearchOptions {
  bool grid = true;        ///< Algorithm 2; false: one cell over everything
  double cell_m = 2.5;     ///< half the width of a cell
  int iterations = 60000;  ///< samples, over all cells
  Sample sample = Sample::three_points;
  bool free_space = true;    ///< samples lose by points in empty space; false: fitness alone, as in the paper
  double edge_ratio = 0.85;  ///< the sides of both triangles agree to this share
  double spacing_m = 0.1;    ///< of the described points, for samples of two normals
  std::size_t propose = 40;
  std::size_t keep_per_cell = 24;  ///< samples; many are of one place
  std::uint64_t seed = 1;
  int threads = 1;
};

/// The paper's grid-RANSAC (section 5.2, Algorithm 2): the target is cut into overlapping cells, RANSAC over
/// feature matches runs in each, in parallel; cells with too few points or covered by their neighbours are left
/// out. Samples are scored on the target's fine field with an early stop. Each cell has its own seed, so the
/// answer does not depend on the number of threads. Needs no gravity.
[[nodiscard]] std::vector<Candidate> feature_search(const Target& target, const Described& target_described,
                                                    const Query& query, const Described& query_described,
                                                    const FeatureSearchOptions& options = {});

/// Each described point of the query with the one of the target that is most like it.
[[nodiscard]] std::vector<FeatureMatch> match_features(const Described& query_described,
                                                       const Described& target_described);

/// Square tiles over x and y, and overlapping cells of up to four of them.
struct Partition {
  std::vector<std::vector<std::uint32_t>> tiles;  ///< feature columns; each column is in one tile
  std::vector<std::vector<std::uint32_t>> cells;  ///< tiles; at least one cell
};
/// Cells twice `cell_m` wide, without those of too few points or that others cover.
[[nodiscard]] Partition partition(const Described& described, double cell_m, std::size_t min_points);

}  // namespace liloc
