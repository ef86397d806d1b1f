#include "common/registration/refine/plane_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/registration/points/simd.hpp"
#include "common/registration/refine/pairs.hpp"

namespace liloc {
namespace {

constexpr float kFar = 1e6F;         // metres: no pair
constexpr std::size_t kColumns = 7;  // of the weighted Jacobian: six unknowns and the residual

LILOC_WIDE void turn(const float* R, const Vectors& from, Vectors* to) {
  const float *x = from.x.data(), *y = from.y.data(), *z = from.z.data();
  float *tx = to->x.data(), *ty = to->y.data(), *tz = to->z.data();
  const std::size_t count = from.x.size();
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) {
    const float a = x[i], b = y[i], c = z[i];
    tx[i] = R[0] * a + R[3] * b + R[6] * c;
    ty[i] = R[1] * a + R[4] * b + R[7] * c;
    tz[i] = R[2] * a + R[5] * b + R[8] * c;
  }
}

/// Each pair's share of the columns; what is not paired adds nothing. Returns how many pairs there are.
LILOC_WIDE int weigh_pairs(const Vectors& arms, const Vectors& normals, const Vectors& offsets,
                           const Vectors& target_normals, float limit, float least, float* rows, float* roots) {
  const float *ax = arms.x.data(), *ay = arms.y.data(), *az = arms.z.data();
  const float *sx = normals.x.data(), *sy = normals.y.data(), *sz = normals.z.data();
  const float *ox = offsets.x.data(), *oy = offsets.y.data(), *oz = offsets.z.data();
  const float *tx = target_normals.x.data(), *ty = target_normals.y.data(), *tz = target_normals.z.data();
  const float width = kKernelShare * limit;
  const std::size_t count = arms.x.size(), stride = count;
  int pairs = 0;
#pragma omp simd reduction(+ : pairs)
  for (std::size_t i = 0; i < count; ++i) {
    const float squared = ox[i] * ox[i] + oy[i] * oy[i] + oz[i] * oz[i];
    const float agreement = sx[i] * tx[i] + sy[i] * ty[i] + sz[i] * tz[i];
    const float x = sx[i] + tx[i], y = sy[i] + ty[i], z = sz[i] + tz[i];
    const float scale = 1.0F / std::sqrt(x * x + y * y + z * z + 1e-20F);
    const float nx = scale * x, ny = scale * y, nz = scale * z;
    const bool paired = (squared <= limit) & (agreement >= least);
    const float root = paired ? width / (width + squared) : 0.0F;
    roots[i] = root;
    rows[i] = root * (ay[i] * nz - az[i] * ny);
    rows[i + stride] = root * (az[i] * nx - ax[i] * nz);
    rows[i + 2 * stride] = root * (ax[i] * ny - ay[i] * nx);
    rows[i + 3 * stride] = root * nx;
    rows[i + 4 * stride] = root * ny;
    rows[i + 5 * stride] = root * nz;
    rows[i + 6 * stride] = root * (nx * ox[i] + ny * oy[i] + nz * oz[i]);
    pairs += paired ? 1 : 0;
  }
  return pairs;
}

/// Sums of the products of each two columns.
LILOC_WIDE void add_products(const float* rows, std::size_t count, float* products) {
  using Floats = float __attribute__((vector_size(Vectors::kLanes * sizeof(float))));
  for (std::size_t a = 0; a < kColumns; ++a) {
    Floats sums[kColumns] = {};
    for (std::size_t i = 0; i < count; i += Vectors::kLanes) {
      Floats left;
      std::memcpy(&left, rows + a * count + i, sizeof left);
      for (std::size_t b = 0; b < kColumns; ++b) {
        Floats right;
        std::memcpy(&right, rows + b * count + i, sizeof right);
        sums[b] += left * right;
      }
    }
    for (std::size_t b = 0; b < kColumns; ++b)
      for (std::size_t lane = 0; lane < Vectors::kLanes; ++lane) products[a * kColumns + b] += sums[b][lane];
  }
}

}  // namespace

PlanePairs::PlanePairs(const Side& side)
    : side_(side),
      source_(side.source.points),
      source_normals_(side.source.normals),
      arms_(side.source.size()),
      normals_(side.source.size()),
      offsets_(side.source.size()),
      target_normals_(side.source.size()),
      partners_(side.source.size()),
      rows_(kColumns * arms_.x.size()),
      roots_(arms_.x.size()) {
  std::ranges::fill(offsets_.x, kFar);
}

/// Partners no farther than the root of `limit`, of points that are not beside somebody.
void PlanePairs::find(const Eigen::Vector3f& t, float limit) {
  const std::size_t count = side_.source.size();
  side_.nearest.nearest(arms_.run(0, count), t, partners_.data());
  for (std::size_t i = 0; i < count; ++i) {
    offsets_.set(i, {kFar, 0, 0});
    if (partners_[i] == NearestGrid::kNone) continue;
    const auto j = static_cast<std::size_t>(partners_[i]);
    const Eigen::Vector3f p = Eigen::Vector3f(arms_.x[i], arms_.y[i], arms_.z[i]) + t;
    const Eigen::Vector3f offset = p - side_.target.points[j];
    if (offset.squaredNorm() > limit || (side_.dynamic_mask != nullptr && side_.dynamic_mask->at(p))) continue;
    offsets_.set(i, offset);
    target_normals_.set(i, side_.target.normals[j]);
  }
}

NormalEquations PlanePairs::sums() const {
  Eigen::Matrix<float, kColumns, kColumns> products;
  products.setZero();
  add_products(rows_.data(), roots_.size(), products.data());
  NormalEquations equations;
  equations.H = products.topLeftCorner<6, 6>().cast<double>();
  equations.g = products.topRightCorner<6, 1>().cast<double>();
  equations.squared = static_cast<double>(products(6, 6));
  for (const float root : roots_) equations.weight += static_cast<double>(root * root);
  return equations;
}

NormalEquations PlanePairs::at(const Pose& T, double distance_m, double min_normal_agreement) {
  const Eigen::Isometry3f Tf = T.cast<float>();
  const Eigen::Matrix3f R = Tf.linear();
  turn(R.data(), source_, &arms_);
  turn(R.data(), source_normals_, &normals_);
  const auto limit = static_cast<float>(distance_m * distance_m);
  find(Tf.translation(), limit);
  const int pairs = weigh_pairs(arms_, normals_, offsets_, target_normals_, limit,
                                static_cast<float>(min_normal_agreement), rows_.data(), roots_.data());
  NormalEquations equations = sums();
  equations.pairs = pairs;
  return equations;
}

}  // namespace liloc
