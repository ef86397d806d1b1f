#include "common/registration/search/feature_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/base/parallel.hpp"
#include "common/registration/features/feature_match.hpp"

namespace liloc {
namespace {

using Nearest = std::vector<FeatureBlock::Nearest>;

/// Each query feature with the nearest that any tile of the cell has.
std::vector<FeatureMatch> matches_in(const Described& query, const Described& target,
                                     const std::vector<std::uint32_t>& cell,
                                     const std::vector<Nearest>& nearest) {
  std::vector<FeatureMatch> matches;
  matches.reserve(query.features.size());
  for (std::size_t i = 0; i < query.features.size(); ++i) {
    FeatureBlock::Nearest best;
    for (const std::uint32_t tile : cell)
      if (!nearest[tile].empty() && nearest[tile][i].closeness > best.closeness) best = nearest[tile][i];
    const std::uint32_t s = query.features.index[i], t = target.features.index[best.column];
    matches.push_back(
        {query.cloud.points[s], target.cloud.points[t], query.cloud.normals[s], target.cloud.normals[t]});
  }
  return matches;
}

/// By the describer, of clouds that stand upright where it is known how.
Features described_upright(const DescribeOptions& options, const Cloud& dense, const Cloud& thinned,
                           const std::vector<std::uint32_t>& index) {
  if (!options.up) return options.describer(dense, thinned, index);
  const Pose T_upright_cloud(Eigen::Quaterniond::FromTwoVectors(*options.up, Eigen::Vector3d::UnitZ()));
  return options.describer(transformed(T_upright_cloud, dense), transformed(T_upright_cloud, thinned), index);
}

}  // namespace

Described describe(const Cloud& thinned, const DescribeOptions& options, const Cloud* dense) {
  Described result{thinned, {}};
  const double most =
      static_cast<double>(options.most) / static_cast<double>(std::max<std::size_t>(1, thinned.size()));
  const double share = std::min(options.sampling, most);
  const std::vector<std::uint32_t> index = sample_indices(thinned.size(), share, options.seed);
  result.features = options.describer
                        ? described_upright(options, dense != nullptr ? *dense : thinned, thinned, index)
                        : fpfh(thinned, index, options.feature_radius_m);
  return result;
}

std::vector<FeatureMatch> match_features(const Described& query_described, const Described& target_described) {
  if (query_described.features.size() == 0 || target_described.features.size() == 0) return {};
  std::vector<std::uint32_t> all(target_described.features.size());
  std::iota(all.begin(), all.end(), 0U);
  std::vector<Nearest> nearest(1, Nearest(query_described.features.size()));
  FeatureBlock(target_described.features, all).improve(query_described.features, nearest.data());
  return matches_in(query_described, target_described, {0}, nearest);
}

Partition partition(const Described& described, double cell_m, std::size_t min_points) {
  Partition result;
  const auto& index = described.features.index;
  Eigen::AlignedBox3f box;
  for (const std::uint32_t i : index) box.extend(described.cloud.points[i]);
  if (index.empty()) return {{{}}, {{0}}};
  const auto half = static_cast<float>(cell_m);
  const Eigen::Array2i last = (box.sizes().head<2>().array() / half).cast<int>().max(1);  // tile of each axis
  const auto number = [&](int x, int y) { return static_cast<std::uint32_t>(x * (last.y() + 1) + y); };
  result.tiles.resize(static_cast<std::size_t>((last + 1).prod()));
  for (std::uint32_t k = 0; k < index.size(); ++k) {
    const Eigen::Array2f at = (described.cloud.points[index[k]] - box.min()).head<2>() / half;
    const Eigen::Array2i tile = at.cast<int>().min(last);
    result.tiles[number(tile.x(), tile.y())].push_back(k);
  }
  std::vector<bool> held(result.tiles.size(), false);  // by a kept cell
  for (int x = 1; x <= last.x(); ++x)
    for (int y = 1; y <= last.y(); ++y) {
      const std::vector<std::uint32_t> cell{number(x - 1, y - 1), number(x - 1, y), number(x, y - 1),
                                            number(x, y)};
      std::size_t size = 0, fresh = 0;
      for (const std::uint32_t tile : cell) {
        size += result.tiles[tile].size();
        fresh += held[tile] ? 0 : result.tiles[tile].size();
      }
      if (size == 0 || size < min_points || fresh * 20 < size) continue;  // too few, or redundant
      for (const std::uint32_t tile : cell) held[tile] = true;
      result.cells.push_back(cell);
    }
  if (!result.cells.empty()) return result;
  result.cells.emplace_back(result.tiles.size());
  std::iota(result.cells.front().begin(), result.cells.front().end(), 0U);
  return result;
}

std::vector<Candidate> feature_search(const Target& target, const Described& target_described,
                                      const Query& query, const Described& query_described,
                                      const FeatureSearchOptions& options) {
  if (query_described.features.size() < 3 || target_described.features.size() < 3) return {};
  const double cell_m = options.grid ? options.cell_m : 1e6;
  const auto [tiles, cells] = partition(target_described, cell_m, query_described.features.size() / 8);
  const int iterations = std::max(1000, options.iterations / static_cast<int>(cells.size()));
  std::vector<Nearest> nearest(
      tiles.size());  // empty where a tile is: they lie between rooms that are far apart
  for_each_index(tiles.size(), options.threads, [&, &tiles = tiles](std::size_t i) {
    if (tiles[i].empty()) return;
    nearest[i].resize(query_described.features.size());
    FeatureBlock(target_described.features, tiles[i]).improve(query_described.features, &nearest[i]);
  });
  std::vector<std::vector<Candidate>> found(cells.size());
  for_each_index(cells.size(), options.threads, [&, &cells = cells](std::size_t i) {
    const SampleOptions samples{
        options.sample,     iterations,        options.keep_per_cell,     options.free_space,
        options.edge_ratio, options.spacing_m, options.seed * 1000003 + i};
    found[i] = sample_poses(target->field_fine(), query.sparse.points,
                            matches_in(query_described, target_described, cells[i], nearest), samples);
  });
  std::vector<Candidate> all;
  for (const auto& f : found) all.insert(all.end(), f.begin(), f.end());
  return distinct(std::move(all), options.propose);
}

}  // namespace liloc
