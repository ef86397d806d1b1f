#include "common/registration/features/fpfh.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <random>
#include <span>

#include "common/registration/points/neighbors.hpp"
#include "common/registration/points/simd.hpp"

namespace liloc {
namespace {

// Rusu, Blodow, Beetz 2009.
constexpr int kBins = 11;
constexpr int kNoBin = kBins;  // of a pair without a Darboux frame
constexpr int kPart = 12;      // a histogram and what goes nowhere
constexpr int kStride = 40;    // three of them, filled up to whole registers

using Histogram = std::array<float, kStride>;

/// A point's neighbours, filled up to whole registers, and the bins that each pair falls in.
struct Pairs {
  std::vector<float> x, y, z, nx, ny, nz;
  std::vector<std::int32_t> alpha, phi, theta;

  void take(const Cloud& cloud, std::span<const std::uint32_t> neighbors) {
    for (auto* floats : {&x, &y, &z, &nx, &ny, &nz}) floats->resize(neighbors.size());
    for (auto* bins : {&alpha, &phi, &theta}) bins->resize(neighbors.size());
    for (std::size_t k = 0; k < neighbors.size(); ++k) {
      const Eigen::Vector3f& p = cloud.points[neighbors[k]];
      const Eigen::Vector3f& n = cloud.normals[neighbors[k]];
      x[k] = p.x(), y[k] = p.y(), z[k] = p.z();
      nx[k] = n.x(), ny[k] = n.y(), nz[k] = n.z();
    }
  }
};

/// The bin of a cosine; what is no number falls in the first.
[[gnu::always_inline]] inline std::int32_t bin_of(float cosine) {
  return static_cast<std::int32_t>(std::min(std::max(0.0F, 0.5F * kBins * (cosine + 1)), kBins - 0.5F));
}

/// The three angles of the pairs of (p, n) with `count` others in their Darboux frames, as bins. The point
/// whose normal u is nearer to the line is the source; v = line x u, w = u x v. The first angle,
/// atan2(w.n, u.n), is found by the edges of its bins at 1, 3, .. 9 elevenths of pi either way, so that no
/// angle has to be computed.
LILOC_WIDE void bin_pairs(const float* x, const float* y, const float* z, const float* nx, const float* ny,
                          const float* nz, int count, const float* p, const float* n, std::int32_t* alpha,
                          std::int32_t* phi, std::int32_t* theta) {
  constexpr float kTiny = 1e-30F;  // keeps zero lengths from dividing
  const float px = p[0], py = p[1], pz = p[2], hx = n[0], hy = n[1], hz = n[2];
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float dx = x[i] - px, dy = y[i] - py, dz = z[i] - pz, tx = nx[i], ty = ny[i], tz = nz[i];
    const float here = hx * dx + hy * dy + hz * dz, there = tx * dx + ty * dy + tz * dz;
    const bool swap = std::abs(here) < std::abs(there);
    const float sign = swap ? -1.0F : 1.0F, u_line = swap ? -there : here;
    const float ux = swap ? tx : hx, uy = swap ? ty : hy, uz = swap ? tz : hz;
    const float ox = swap ? hx : tx, oy = swap ? hy : ty, oz = swap ? hz : tz;
    const float vx = sign * (dy * uz - dz * uy), vy = sign * (dz * ux - dx * uz),
                vz = sign * (dx * uy - dy * ux);
    const float wx = uy * vz - uz * vy, wy = uz * vx - ux * vz, wz = ux * vy - uy * vx;
    const float v_length = std::sqrt(vx * vx + vy * vy + vz * vz);
    const float length = std::sqrt(dx * dx + dy * dy + dz * dz);
    const float across = wx * ox + wy * oy + wz * oz;              // |v| times w.n
    const float along = v_length * (ux * ox + uy * oy + uz * oz);  // |v| times u.n
    const float upright = std::abs(across);
    const std::int32_t edges = (0.95949297F * upright >= 0.28173256F * along ? 1 : 0) +
                               (0.65486073F * upright >= 0.75574957F * along ? 1 : 0) +
                               (0.14231484F * upright >= 0.98982144F * along ? 1 : 0) +
                               (-0.41541501F * upright >= 0.90963200F * along ? 1 : 0) +
                               (-0.84125353F * upright >= 0.54064082F * along ? 1 : 0);
    const std::int32_t turn = across < 0 ? 5 - edges : 5 + edges;
    const std::int32_t bin_v = bin_of((vx * ox + vy * oy + vz * oz) / (v_length + kTiny)),
                       bin_u = bin_of(u_line / (length + kTiny));
    alpha[i] = v_length > 0 ? turn : kNoBin;
    phi[i] = v_length > 0 ? bin_v : kNoBin;
    theta[i] = v_length > 0 ? bin_u : kNoBin;
  }
}

/// The simplified histogram of one point: itself against each neighbour, as per cent.
Histogram simplified(const Cloud& cloud, std::uint32_t i, std::span<const std::uint32_t> neighbors,
                     Pairs* pairs) {
  pairs->take(cloud, neighbors);
  bin_pairs(pairs->x.data(), pairs->y.data(), pairs->z.data(), pairs->nx.data(), pairs->ny.data(),
            pairs->nz.data(), static_cast<int>(neighbors.size()), cloud.points[i].data(),
            cloud.normals[i].data(), pairs->alpha.data(), pairs->phi.data(), pairs->theta.data());
  std::array<std::int32_t, kStride> counts{};
  for (std::size_t k = 0; k < neighbors.size(); ++k) {
    ++counts[static_cast<std::size_t>(pairs->alpha[k])];
    ++counts[static_cast<std::size_t>(kPart + pairs->phi[k])];
    ++counts[static_cast<std::size_t>(2 * kPart + pairs->theta[k])];
  }
  Histogram histogram{};
  if (neighbors.size() < 2) return histogram;  // the point alone
  const float percent = 100.0F / static_cast<float>(neighbors.size() - 1);
  for (std::size_t b = 0; b < kStride; ++b) histogram[b] = percent * static_cast<float>(counts[b]);
  return histogram;
}

/// Adds up the neighbours' histograms, the nearer the more.
LILOC_WIDE void weigh(const Histogram* simple, const std::uint32_t* neighbors, const float* squared,
                      std::size_t count, Histogram* sum) {
  using Eight = float __attribute__((vector_size(32)));
  Eight total[kStride / 8] = {};
  for (std::size_t k = 0; k < count; ++k) {
    const float weight = squared[k] > 0 ? 1.0F / squared[k] : 0.0F;
    const float* h = simple[neighbors[k]].data();
    for (int b = 0; b < kStride / 8; ++b) {
      Eight part;
      std::memcpy(&part, h + 8 * b, sizeof part);
      total[b] += weight * part;
    }
  }
  std::memcpy(sum->data(), total, sizeof total);
}

void normalize(const Histogram& histogram, Eigen::Ref<Eigen::Matrix<float, kFpfhSize, 1>> descriptor) {
  for (int part = 0; part < 3; ++part) {
    const Eigen::Map<const Eigen::Matrix<float, kBins, 1>> bins(histogram.data() + part * kPart);
    const float sum = bins.sum();
    descriptor.segment<kBins>(part * kBins) = (sum > 0 ? 100.0F / sum : 0.0F) * bins;
  }
}

}  // namespace

Features fpfh(const Cloud& cloud, const std::vector<std::uint32_t>& index, double radius_m) {
  assert(cloud.has_normals() || index.empty());
  Features features{index, {}};
  features.descriptors.setZero(kFpfhSize, static_cast<Eigen::Index>(index.size()));
  if (index.empty()) return features;
  const RadiusSearch search(cloud.points, radius_m);
  std::vector<Histogram> simple(cloud.size());
  Pairs pairs;
  search.for_each_neighborhood([&](std::uint32_t i, const RadiusSearch::Neighborhood& near) {
    simple[i] = simplified(cloud, i, near.index, &pairs);
  });
  std::vector<std::int32_t> column(cloud.size(), -1);
  for (std::size_t k = 0; k < index.size(); ++k) column[index[k]] = static_cast<std::int32_t>(k);
  search.for_each_neighborhood([&](std::uint32_t i, const RadiusSearch::Neighborhood& near) {
    if (column[i] < 0) return;
    Histogram sum;
    weigh(simple.data(), near.index.data(), near.squared.data(), near.index.size(), &sum);
    normalize(sum, features.descriptors.col(column[i]));
  });
  return features;
}

std::vector<std::uint32_t> sample_indices(std::size_t count, double share, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  const auto threshold = static_cast<std::uint64_t>(std::clamp(share, 0.0, 1.0) * 4294967296.0);
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i < count; ++i)
    if ((rng() >> 32) < threshold) index.push_back(i);
  return index;
}

}  // namespace liloc
