#include "common/registration/feature_search.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <random>
#include <thread>

#include "common/registration/feature_match.hpp"

namespace liloc {
namespace {

struct Match {
  Eigen::Vector3f source, target, source_normal, target_normal;
};

using Nearest = std::vector<FeatureBlock::Nearest>;

/// Each query feature with the nearest that any tile of the cell has.
std::vector<Match> matches_in(const Described& query, const Described& target,
                              const std::vector<std::uint32_t>& cell, const std::vector<Nearest>& nearest) {
  std::vector<Match> matches;
  matches.reserve(query.features.size());
  for (std::size_t i = 0; i < query.features.size(); ++i) {
    FeatureBlock::Nearest best;
    for (const std::uint32_t tile : cell)
      if (nearest[tile][i].closeness > best.closeness) best = nearest[tile][i];
    const std::uint32_t s = query.features.index[i], t = target.features.index[best.column];
    matches.push_back(
        {query.cloud.points[s], target.cloud.points[t], query.cloud.normals[s], target.cloud.normals[t]});
  }
  return matches;
}

bool sides_agree(const Match& a, const Match& b, float ratio) {
  const float source = (a.source - b.source).norm(), target = (a.target - b.target).norm();
  return std::min(source, target) > 0.3F && std::min(source, target) >= ratio * std::max(source, target);
}

/// Least-squares rigid transform of three pairs (Umeyama 1991, without scale).
Eigen::Isometry3f from_three(const Match& a, const Match& b, const Match& c) {
  const Eigen::Vector3f source = (a.source + b.source + c.source) / 3,
                        target = (a.target + b.target + c.target) / 3;
  const Eigen::Matrix3f covariance = (a.target - target) * (a.source - source).transpose() +
                                     (b.target - target) * (b.source - source).transpose() +
                                     (c.target - target) * (c.source - source).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3f> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3f signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0F : 1.0F);
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
  T.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  T.translation() = target - T.linear() * source;
  return T;
}

bool normals_agree(const Eigen::Isometry3f& T, const Match& m) {
  return (T.linear() * m.source_normal).dot(m.target_normal) > 0.7F;
}

/// Mean worth of the points on the field, each at least `least`, or a low value as soon as the first points
/// promise less than `floor`.
float field_score(const ScoreField& field, const std::vector<Eigen::Vector3f>& points,
                  const Eigen::Isometry3f& T, int least, float floor) {
  int sum = 0, seen = 0;
  for (const auto& p : points) {
    sum += std::max(least, field.at(T * p, ScoreField::kAny));
    if (++seen == 60 && static_cast<float>(sum) < 0.6F * floor * 60) return -1e9F;
  }
  return static_cast<float>(sum) / static_cast<float>(std::max(seen, 1));
}

/// work(0), work(1), .. work(count - 1), by so many threads.
template <class Work>
void for_each_index(std::size_t count, int threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto take = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> pool;
  for (int t = 1; t < std::clamp(threads, 1, 64); ++t) pool.emplace_back(take);
  take();
}

std::vector<Candidate> ransac(const ScoreField& field, const std::vector<Eigen::Vector3f>& points,
                              const std::vector<Match>& matches, int iterations,
                              const FeatureSearchOptions& options, std::uint64_t seed) {
  std::vector<Candidate> best;
  if (matches.size() < 3) return best;
  const auto edge_ratio = static_cast<float>(options.edge_ratio);
  const int least = options.free_space ? -ScoreField::kSurface : 0;
  std::mt19937_64 rng(seed);
  const auto worse = [](const Candidate& a, const Candidate& b) { return a.score > b.score; };
  float floor = 0;
  for (int i = 0; i < iterations; ++i) {
    const Match& a = matches[rng() % matches.size()];
    const Match& b = matches[rng() % matches.size()];
    if (!sides_agree(a, b, edge_ratio)) continue;
    const Match& c = matches[rng() % matches.size()];
    if (!sides_agree(a, c, edge_ratio) || !sides_agree(b, c, edge_ratio)) continue;
    const Eigen::Isometry3f T = from_three(a, b, c);
    if (!normals_agree(T, a) || !normals_agree(T, b) || !normals_agree(T, c)) continue;
    const float score = field_score(field, points, T, least, floor);
    if (score <= floor) continue;
    best.push_back({T.cast<double>(), score / ScoreField::kSurface});
    std::push_heap(best.begin(), best.end(), worse);
    if (best.size() > options.keep_per_cell) {
      std::pop_heap(best.begin(), best.end(), worse);
      best.pop_back();
      floor = static_cast<float>(best.front().score) * ScoreField::kSurface;
    }
  }
  return best;
}

}  // namespace

Described describe(const Cloud& thinned, const DescribeOptions& options) {
  Described result{thinned, {}};
  const double most =
      static_cast<double>(options.most) / static_cast<double>(std::max<std::size_t>(1, thinned.size()));
  const double share = std::min(options.sampling, most);
  result.features =
      fpfh(thinned, sample_indices(thinned.size(), share, options.seed), options.feature_radius_m);
  return result;
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
  std::vector<Nearest> nearest(tiles.size(), Nearest(query_described.features.size()));
  for_each_index(tiles.size(), options.threads, [&, &tiles = tiles](std::size_t i) {
    FeatureBlock(target_described.features, tiles[i]).improve(query_described.features, &nearest[i]);
  });
  std::vector<std::vector<Candidate>> found(cells.size());
  for_each_index(cells.size(), options.threads, [&, &cells = cells](std::size_t i) {
    found[i] = ransac(target->field_fine(), query.sparse.points,
                      matches_in(query_described, target_described, cells[i], nearest), iterations, options,
                      options.seed * 1000003 + i);
  });
  std::vector<Candidate> all;
  for (const auto& f : found) all.insert(all.end(), f.begin(), f.end());
  return distinct(std::move(all), options.propose);
}

}  // namespace liloc
