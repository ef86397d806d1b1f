#include "server/survey/joint_refine.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/registration/refine/pairs.hpp"

namespace liloc::survey {
namespace {

constexpr int kUnknowns = 8;  // turn about the sensor, shift, depth scale, depth bias
using Row = Eigen::Matrix<double, kUnknowns, 1>;
using Block = Eigen::Matrix<double, kUnknowns, kUnknowns>;
// A pair's distance from its plane, and the points that share one error: neighbours on a surface err alike.
constexpr double kPairSd_m = 0.005, kAlike = 25;

/// One LiDAR's cloud of this iteration, and an index over it.
struct Placed {
  Cloud cloud;
  NearestGrid nearest;
};

/// How the distance along `normal` changes with a LiDAR's unknowns; `arm` from its sensor, in the map's axes.
Row row_of(const Eigen::Vector3f& arm, const Eigen::Vector3f& normal, const Eigen::Matrix3d& R_map_sensor) {
  Row row;
  row.head<6>() = jacobian_of(arm, normal);
  const double along = static_cast<double>(normal.dot(arm));
  const double z = std::max(0.25, R_map_sensor.col(2).dot(arm.cast<double>()));
  row[6] = along;
  row[7] = along / z;
  return row;
}

class Normals {
 public:
  Normals(std::vector<JointLidar>* lidars, const JointOptions& options)
      : lidars_(*lidars),
        options_(options),
        H_(Eigen::MatrixXd::Zero(size(), size())),
        g_(Eigen::VectorXd::Zero(size())) {
    for (JointLidar& lidar : lidars_)
      if (!lidar.left_out) lidar.residual_m = lidar.pairs = 0;
  }

  void add_scan(const Reference& reference, std::size_t i, const Cloud& cloud, double distance_m) {
    const Pose& T = lidars_[i].T_map_sensor;
    const Cloud facing = reference.facing(T.translation().cast<float>());
    for_each_pair(Side{facing, reference.nearest(), cloud}, T, distance_m, options_.min_normal_agreement,
                  [&](std::size_t, const Eigen::Vector3f& arm, const Eigen::Vector3f& normal,
                      const Eigen::Vector3f& offset,
                      double weight) { add(i, row_of(arm, normal, T.linear()), normal.dot(offset), weight); });
  }

  void add_two(std::size_t i, std::size_t j, const std::vector<Placed>& placed, double distance_m) {
    const Pose& T_i = lidars_[i].T_map_sensor;
    const Pose& T_j = lidars_[j].T_map_sensor;
    const Eigen::Matrix3f R_j = T_j.linear().cast<float>();
    const Eigen::Vector3f t_j_i = (T_i.translation() - T_j.translation()).cast<float>();
    for_each_pair(Side{placed[j].cloud, placed[j].nearest, placed[i].cloud}, T_j.inverse() * T_i, distance_m,
                  options_.min_normal_agreement,
                  [&](std::size_t, const Eigen::Vector3f& arm_j, const Eigen::Vector3f& normal_j,
                      const Eigen::Vector3f& offset_j, double weight) {
                    const Eigen::Vector3f arm = R_j * arm_j, normal = R_j * normal_j;
                    const Row row_i = row_of(arm, normal, T_i.linear());
                    const Row row_j = -row_of(arm + t_j_i - R_j * offset_j, normal, T_j.linear());
                    add(i, row_i, normal_j.dot(offset_j), weight);
                    add_own(j, row_j, normal_j.dot(offset_j), weight);
                    block(i, j).noalias() += weight * row_i * row_j.transpose();
                    block(j, i).noalias() += weight * row_j * row_i.transpose();
                  });
  }

  /// Steps of all LiDARs; moves them. The largest one.
  double step() {
    hold();
    solver_.compute(H_);
    const Eigen::VectorXd x = -solver_.solve(g_);
    double largest = 0;
    for (std::size_t i = 0; i < lidars_.size(); ++i) {
      const Row own = x.segment<kUnknowns>(at(i));
      JointLidar& lidar = lidars_[i];
      if (!own.allFinite()) continue;
      if (lidar.left_out) continue;
      if (lidar.pairs > 0) lidar.residual_m = std::sqrt(lidar.residual_m / lidar.pairs);
      lidar.T_map_sensor.linear() = so3_exp(own.head<3>()) * lidar.T_map_sensor.linear();
      lidar.T_map_sensor.translation() += own.segment<3>(3);
      lidar.error.scale += own[6];
      lidar.error.bias_m += own[7];
      largest = std::max(largest, own.cwiseAbs().maxCoeff());
    }
    return largest;
  }

  /// Of the last step.
  void tell_doubt() const {
    const double unit = kAlike * kPairSd_m * kPairSd_m;
    for (std::size_t i = 0; i < lidars_.size(); ++i) {
      Eigen::MatrixXd own = Eigen::MatrixXd::Zero(size(), kUnknowns);
      own.middleRows<kUnknowns>(at(i)).setIdentity();
      const Block covariance = unit * solver_.solve(own).middleRows<kUnknowns>(at(i));
      lidars_[i].covariance = covariance.topLeftCorner<6, 6>();
      lidars_[i].error_sd = {std::sqrt(std::max(0.0, covariance(6, 6))),
                             std::sqrt(std::max(0.0, covariance(7, 7)))};
    }
  }

 private:
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(lidars_.size()) * kUnknowns; }
  [[nodiscard]] static Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i) * kUnknowns; }
  [[nodiscard]] Eigen::Block<Eigen::MatrixXd, kUnknowns, kUnknowns> block(std::size_t i, std::size_t j) {
    return H_.block<kUnknowns, kUnknowns>(at(i), at(j));
  }

  void add_own(std::size_t i, const Row& row, double residual_m, double weight) {
    block(i, i).noalias() += weight * row * row.transpose();
    g_.segment<kUnknowns>(at(i)) += weight * residual_m * row;
  }
  void add(std::size_t i, const Row& row, double residual_m, double weight) {
    add_own(i, row, residual_m, weight);
    lidars_[i].residual_m += residual_m * residual_m;
    ++lidars_[i].pairs;
  }

  /// What is known beforehand, and a little of everything that nothing else observes.
  void hold() {
    const double unit = kAlike * kPairSd_m * kPairSd_m;
    for (std::size_t i = 0; i < lidars_.size(); ++i) {
      const JointLidar& lidar = lidars_[i];
      Row held = Row::Constant(1e-3);
      // Of LiDARs alone one keeps its scale: all smaller together fit each other better.
      const bool errors = options_.depth_errors && !lidar.left_out && !lidar.fixed;
      held[6] = errors ? unit / (options_.scale_sd * options_.scale_sd) : kFixed;
      held[7] = errors ? unit / (options_.bias_sd_m * options_.bias_sd_m) : kFixed;
      if (lidar.fixed || lidar.left_out) held.head<6>().setConstant(kFixed);
      block(i, i).diagonal() += held;
      if (errors) {
        g_[at(i) + 6] += held[6] * lidar.error.scale;
        g_[at(i) + 7] += held[7] * lidar.error.bias_m;
      }
    }
  }

  Eigen::LDLT<Eigen::MatrixXd> solver_;
  static constexpr double kFixed = 1e12;  // information that holds a pose where it is
  std::vector<JointLidar>& lidars_;
  const JointOptions& options_;
  Eigen::MatrixXd H_;
  Eigen::VectorXd g_;
};

std::vector<Placed> placed(const std::vector<JointLidar>& lidars, const JointOptions& options) {
  std::vector<Placed> all;
  for (const JointLidar& lidar : lidars) {
    Cloud cloud = corrected(*lidar.cloud, lidar.error);
    NearestGrid nearest(cloud.points, options.voxel_size_m, options.start_distance_m);
    all.push_back({std::move(cloud), std::move(nearest)});
  }
  return all;
}

}  // namespace

void refine_together(const Reference* reference, std::vector<JointLidar>* lidars, const JointOptions& options) {
  constexpr double kSmallStep = 5e-5;  // m, rad
  std::vector<Placed> clouds = placed(*lidars, options);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    const double share = std::min(1.0, 1.5 * iteration / (options.iterations - 1.0));
    const double distance_m =
        options.start_distance_m * std::pow(options.end_distance_m / options.start_distance_m, share);
    if (options.depth_errors) clouds = placed(*lidars, options);
    Normals normals(lidars, options);
    for (std::size_t i = 0; i < lidars->size(); ++i) {
      if ((*lidars)[i].left_out) continue;
      if (reference != nullptr) normals.add_scan(*reference, i, clouds[i].cloud, distance_m);
      for (std::size_t j = 0; j < lidars->size(); ++j)
        if (i != j && !(*lidars)[j].left_out) normals.add_two(i, j, clouds, distance_m);
    }
    const bool last = (normals.step() < kSmallStep && share >= 1.0) || iteration + 1 == options.iterations;
    if (last && options.depth_errors) normals.tell_doubt();
    if (last) return;
  }
}

}  // namespace liloc::survey
