#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct PatchOptions {
  /// Of the cubes whose surfaces are taken for one thing; 0.6 is alike (scan/DECISIONS.md).
  double size_m = 0.4;
  double common_sd_m = 0.008;  ///< of the error that all points of a patch share; 4 to 12 mm are alike
  double lasting = 5;  ///< that error hardly changes from frame to frame, so a patch tells so many times
                       ///< more of a step than it would with a new one in each frame
  /// Of what noise and the guess explain, where a patch begins to count less; 2 is alike.
  double deviations = 3;
};

/// Numbers points by the cube that they lie in and the way they face (six sides), from 0.
class PatchNumbers {
 public:
  explicit PatchNumbers(double size_m) : inverse_(static_cast<float>(1 / size_m)) {}
  [[nodiscard]] std::uint32_t of(const Eigen::Vector3f& point, const Eigen::Vector3f& normal);
  [[nodiscard]] std::size_t count() const { return numbers_.size(); }

 private:
  float inverse_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
};

/// How much the points of each patch count together. Neighbours err together and move together: a patch is one
/// witness, however many points a person close by has, and it is off when its mean is, although each of its
/// points is within the noise.
class PatchWeights {
 public:
  using Matrix6f = Eigen::Matrix<float, 6, 6>;
  using Vector6f = Eigen::Matrix<float, 6, 1>;

  explicit PatchWeights(std::size_t patches) : sums_(patches) {}
  /// A pair's distance from its plane (metres) with its variance and weight; `jacobian`: of the distance by the
  /// pose.
  void add(std::uint32_t patch, float weight, float residual, float variance, const Vector6f& jacobian);
  /// A factor for the weights of each patch's pairs; `doubt`: covariance of the pose, as far as residuals
  /// may come from it.
  [[nodiscard]] std::vector<float> weights(const Matrix6f& doubt, const PatchOptions& options) const;

 private:
  struct Sum {
    float weight = 0, residual = 0, variance = 0;
    Vector6f jacobian = Vector6f::Zero();
  };
  std::vector<Sum> sums_;
};

}  // namespace liloc
