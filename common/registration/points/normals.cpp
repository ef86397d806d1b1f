#include "common/registration/points/normals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>

#include "common/registration/points/neighbors.hpp"
#include "common/registration/points/simd.hpp"

namespace liloc {
namespace {

constexpr std::size_t kSums = 10;   // count, mean and second moments of a neighbourhood
constexpr int kNewtonSteps = 6;     // by hand
constexpr float kNoPlane = 1e-10F;  // squared; below, rounding decides what is across
constexpr double kWiden = 1.5;      // by hand, as the third of the points (target/DECISIONS.md)

/// Of each point's neighbourhood: count, sums, and sums of products of the offsets from the point. Relative to
/// it, single precision loses nothing. Ten rows of one value per point.
struct Moments {
  explicit Moments(std::size_t points) : count(points), rows(kSums * points, 0.0F) {}
  std::size_t count;
  std::vector<float> rows;
};

/// Those of `p`, one value per row at `sums`, `stride` apart.
LILOC_WIDE void add_up(const float* xs, const float* ys, const float* zs, int count, const float* p,
                       float squared_radius, float* sums, std::size_t stride) {
  float n = 0, sx = 0, sy = 0, sz = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  const float px = p[0], py = p[1], pz = p[2];
#pragma omp simd reduction(+ : n, sx, sy, sz, xx, xy, xz, yy, yz, zz)
  for (int i = 0; i < count; ++i) {
    const float dx = xs[i] - px, dy = ys[i] - py, dz = zs[i] - pz;
    const float inside = dx * dx + dy * dy + dz * dz <= squared_radius ? 1.0F : 0.0F;
    const float wx = inside * dx, wy = inside * dy, wz = inside * dz;
    n += inside;
    sx += wx;
    sy += wy;
    sz += wz;
    xx += wx * dx;
    xy += wx * dy;
    xz += wx * dz;
    yy += wy * dy;
    yz += wy * dz;
    zz += wz * dz;
  }
  const float all[kSums] = {n, sx, sy, sz, xx, xy, xz, yy, yz, zz};
  for (std::size_t k = 0; k < kSums; ++k) sums[k * stride] = all[k];
}

/// The direction in which each neighbourhood is thinnest, unit; zero where two are. The least eigenvalue of the
/// covariance by Newton's method from below, where the characteristic polynomial rises and is concave; across
/// the rows of what it leaves lies its eigenvector.
LILOC_WIDE void thinnest_directions(const float* m, std::size_t count, float* nx, float* ny, float* nz) {
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) {
    const float inverse = 1.0F / (m[i] > 1 ? m[i] : 1.0F);
    const float x = m[i + count] * inverse, y = m[i + 2 * count] * inverse, z = m[i + 3 * count] * inverse;
    const float xx = m[i + 4 * count] * inverse - x * x, yy = m[i + 7 * count] * inverse - y * y,
                zz = m[i + 9 * count] * inverse - z * z;
    const float trace = xx + yy + zz, scale = trace > 1e-20F ? 1.0F / trace : 0.0F;
    const float a = scale * xx, d = scale * yy, f = scale * zz,
                b = scale * (m[i + 5 * count] * inverse - x * y),
                c = scale * (m[i + 6 * count] * inverse - x * z),
                e = scale * (m[i + 8 * count] * inverse - y * z);
    const float minors = a * d - b * b + a * f - c * c + d * f - e * e;
    const float determinant = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d);
    float least = 0;
#pragma GCC unroll 8
    for (int step = 0; step < kNewtonSteps; ++step) {
      const float value = ((least - 1) * least + minors) * least - determinant,
                  slope = (3 * least - 2) * least + minors;
      least -= slope > 1e-6F ? value / slope : 0.0F;
    }
    const float p = a - least, q = d - least, r = f - least;
    const float ux = b * e - c * q, uy = c * b - p * e, uz = p * q - b * b;
    const float vx = b * r - c * e, vy = c * c - p * r, vz = p * e - b * c;
    const float wx = q * r - e * e, wy = e * c - b * r, wz = b * e - q * c;
    const float uu = ux * ux + uy * uy + uz * uz, vv = vx * vx + vy * vy + vz * vz,
                ww = wx * wx + wy * wy + wz * wz;
    const bool u_most = (uu >= vv) & (uu >= ww), v_most = vv >= ww;
    const float squared = u_most ? uu : v_most ? vv : ww;
    const float unit = squared > kNoPlane ? 1.0F / std::sqrt(squared) : 0.0F;
    nx[i] = unit * (u_most ? ux : v_most ? vx : wx);
    ny[i] = unit * (u_most ? uy : v_most ? vy : wy);
    nz[i] = unit * (u_most ? uz : v_most ? vz : wz);
  }
}

/// The same for one neighbourhood, whatever its shape: any of the directions that are thinnest.
Eigen::Vector3f a_thinnest_direction(const Moments& moments, std::size_t i) {
  const auto m = [&](std::size_t k) { return moments.rows[k * moments.count + i]; };
  const Eigen::Vector3f mean = Eigen::Vector3f(m(1), m(2), m(3)) / m(0);
  Eigen::Matrix3f squares;
  squares << m(4), m(5), m(6), m(5), m(7), m(8), m(6), m(8), m(9);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
  eigen.computeDirect(squares / m(0) - mean * mean.transpose());
  return eigen.eigenvectors().col(0).stableNormalized();
}

Moments moments_of(const Cloud& cloud, float radius_m) {
  Moments moments(cloud.size());
  const RadiusSearch search(cloud.points, static_cast<double>(radius_m));
  search.for_each_cell([&](std::span<const std::uint32_t> own, const RadiusSearch::Points& nearby) {
    for (const std::uint32_t i : own)
      add_up(nearby.x.data(), nearby.y.data(), nearby.z.data(), static_cast<int>(nearby.x.size()),
             cloud.points[i].data(), radius_m * radius_m, &moments.rows[i], moments.count);
  });
  return moments;
}

/// Of neighbourhoods as wide as it takes.
Moments widened_moments(const Cloud& cloud, const NormalOptions& options, float fewest) {
  double radius_m = options.radius_m;
  Moments moments = moments_of(cloud, static_cast<float>(radius_m));
  const auto holds_together = [&] {
    const auto begin = moments.rows.begin(), end = begin + static_cast<std::ptrdiff_t>(cloud.size());
    return 3 * std::count_if(begin, end, [&](float count) { return count >= fewest; }) >= end - begin;
  };
  while (options.widest_m > 0 && !holds_together() && (radius_m *= kWiden) < options.widest_m)
    moments = moments_of(cloud, static_cast<float>(radius_m));
  return moments;
}

}  // namespace

Cloud with_normals(const Cloud& cloud, const Eigen::Vector3f& sensor_position, const NormalOptions& options) {
  const auto fewest = static_cast<float>(std::max(1, options.min_neighbors));
  const Moments moments = widened_moments(cloud, options, fewest);
  std::vector<float> x(cloud.size()), y(cloud.size()), z(cloud.size());
  thinnest_directions(moments.rows.data(), cloud.size(), x.data(), y.data(), z.data());
  Cloud result;
  result.points.reserve(cloud.size());
  result.normals.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (moments.rows[i] < fewest) continue;
    Eigen::Vector3f normal(x[i], y[i], z[i]);
    if (normal.isZero()) normal = a_thinnest_direction(moments, i);
    const Eigen::Vector3f& p = cloud.points[i];
    result.points.push_back(p);
    result.normals.push_back(normal.dot(sensor_position - p) < 0 ? Eigen::Vector3f(-normal) : normal);
  }
  return result;
}

}  // namespace liloc
