#include "common/registration/feature_search.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <random>
#include <thread>

namespace liloc {
namespace {

struct Match {
  Eigen::Vector3f source, target, source_normal, target_normal;
};

/// Nearest descriptor of the cell for each query feature, by one matrix product.
std::vector<Match> match_features(const Described& query, const Described& target,
                                  const std::vector<std::uint32_t>& cell) {
  const auto columns = static_cast<Eigen::Index>(cell.size());
  Eigen::Matrix<float, kFpfhSize, Eigen::Dynamic> picked(kFpfhSize, columns);
  for (Eigen::Index i = 0; i < columns; ++i)
    picked.col(i) = target.features.descriptors.col(cell[static_cast<std::size_t>(i)]);
  const Eigen::VectorXf half_squared = 0.5F * picked.colwise().squaredNorm().transpose();
  std::vector<Match> matches;
  matches.reserve(query.features.size());
  constexpr Eigen::Index kBlock = 64;  // the product of a block stays in cache
  const auto count = static_cast<Eigen::Index>(query.features.size());
  for (Eigen::Index begin = 0; begin < count; begin += kBlock) {
    const Eigen::Index size = std::min(kBlock, count - begin);
    Eigen::MatrixXf similarity = picked.transpose() * query.features.descriptors.middleCols(begin, size);
    similarity.colwise() -= half_squared;
    for (Eigen::Index i = 0; i < size; ++i) {
      Eigen::Index best = 0;
      similarity.col(i).maxCoeff(&best);
      const std::uint32_t s = query.features.index[static_cast<std::size_t>(begin + i)];
      const std::uint32_t t = target.features.index[cell[static_cast<std::size_t>(best)]];
      matches.push_back(
          {query.cloud.points[s], target.cloud.points[t], query.cloud.normals[s], target.cloud.normals[t]});
    }
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

std::vector<Candidate> ransac(const ScoreField& field, const std::vector<Eigen::Vector3f>& points,
                              const std::vector<Match>& matches, int iterations,
                              const FeatureSearchOptions& options, std::uint64_t seed) {
  constexpr std::size_t kKeep = 24;
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
    if (best.size() > kKeep) {
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

std::vector<std::vector<std::uint32_t>> partition(const Described& described, double cell_m,
                                                  std::size_t min_points) {
  std::vector<std::vector<std::uint32_t>> cells;
  const auto& index = described.features.index;
  std::vector<std::uint32_t> all(index.size());
  std::iota(all.begin(), all.end(), 0U);
  Eigen::AlignedBox3f box;
  for (const std::uint32_t i : index) box.extend(described.cloud.points[i]);
  if (index.empty()) return {all};
  const auto half = static_cast<float>(cell_m);
  const int nx = std::max(1, static_cast<int>(box.sizes().x() / half)),
            ny = std::max(1, static_cast<int>(box.sizes().y() / half));
  std::vector<int> held(index.size(), 0);  // by how many kept cells
  for (int x = 1; x <= nx; ++x)
    for (int y = 1; y <= ny; ++y) {
      const Eigen::Vector2f centre = box.min().head<2>() + half * Eigen::Vector2f(x, y);
      std::vector<std::uint32_t> cell;
      std::size_t fresh = 0;
      for (const std::uint32_t k : all) {
        if (((described.cloud.points[index[k]].head<2>() - centre).array().abs() > half).any()) continue;
        cell.push_back(k);
        fresh += held[k] == 0;
      }
      if (cell.size() < min_points || fresh * 20 < cell.size()) continue;  // too few, or redundant
      for (const std::uint32_t k : cell) ++held[k];
      cells.push_back(std::move(cell));
    }
  if (cells.empty()) cells.push_back(std::move(all));
  return cells;
}

std::vector<Candidate> feature_search(const Target& target, const Described& target_described,
                                      const Query& query, const Described& query_described,
                                      const FeatureSearchOptions& options) {
  if (query_described.features.size() < 3 || target_described.features.size() < 3) return {};
  const double cell_m = options.grid ? options.cell_m : 1e6;
  const auto cells = partition(target_described, cell_m, query_described.features.size() / 8);
  const int iterations = std::max(1000, options.iterations / static_cast<int>(cells.size()));
  std::vector<std::vector<Candidate>> found(cells.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < cells.size(); i = next++)
      found[i] = ransac(target->field_fine(), query.sparse.points,
                        match_features(query_described, target_described, cells[i]), iterations, options,
                        options.seed * 1000003 + i);
  };
  {
    std::vector<std::jthread> pool;
    for (int t = 1; t < std::clamp(options.threads, 1, 64); ++t) pool.emplace_back(work);
    work();
  }
  std::vector<Candidate> all;
  for (const auto& f : found) all.insert(all.end(), f.begin(), f.end());
  return distinct(std::move(all), options.propose);
}

}  // namespace liloc
