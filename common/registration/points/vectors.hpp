#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace liloc {

/// Some points in arrays.
struct PointRun {
  const float *x, *y, *z;
  std::size_t count;
};

/// One vector per point as arrays, filled up with zeros to whole registers.
struct Vectors {
  static constexpr std::size_t kLanes = 8;  ///< floats of an AVX2 register
  std::vector<float> x, y, z;

  explicit Vectors(std::size_t count)
      : x((count + kLanes - 1) / kLanes * kLanes, 0.0F), y(x.size(), 0.0F), z(x.size(), 0.0F) {}
  explicit Vectors(const std::vector<Eigen::Vector3f>& vectors) : Vectors(vectors.size()) {
    for (std::size_t i = 0; i < vectors.size(); ++i) set(i, vectors[i]);
  }
  [[nodiscard]] PointRun run(std::size_t begin, std::size_t count) const {
    return {x.data() + begin, y.data() + begin, z.data() + begin, count};
  }
  void set(std::size_t i, const Eigen::Vector3f& v) { x[i] = v.x(), y[i] = v.y(), z[i] = v.z(); }
};

}  // namespace liloc
