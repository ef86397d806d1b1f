#pragma once
#include "client/inertial/preintegration.hpp"

namespace liloc {

/// Where an IMU is, how it moves and how it errs; odometry axes.
struct InertialState {
  Pose T_odom_imu = Pose::Identity();
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  ImuBias bias;
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d(0, 0, -9.81);  ///< downwards
};

/// What is known before the first prediction, with one standard deviation per axis.
struct InertialStart {
  Pose T_odom_imu = Pose::Identity();
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  double velocity_sd_m_s = 1.0;
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  double gyro_bias_sd_rad_s = 0.02;
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d(0, 0, 9.81);  ///< mean specific force at rest, IMU axes
  double force_sd_m_s2 = 0.5;
};

/// An error-state Kalman filter over preintegrated spans: the registration's poses teach it velocity, both
/// biases and the direction of gravity, and it says where the next frame will be and how sure that is. Rotation
/// errors turn on the left (odometry axes). Not thread-safe.
class InertialFilter {
 public:
  // Where the states begin.
  static constexpr int kTurn = 0, kPlace = 3, kVelocity = 6, kGyroBias = 9, kAccelBias = 12, kGravity = 15;
  using Matrix18d = Eigen::Matrix<double, 18, 18>;

  explicit InertialFilter(const InertialStart& start);

  /// Moves on over a span of samples (as `preintegrate` takes them).
  void predict(const std::vector<ImuSample>& samples);
  /// The pose at the last prediction's end is `T_odom_imu` with this covariance, [rotation; translation],
  /// odometry axes about the IMU: the outcome of a measurement and the prediction together.
  void update(const Pose& T_odom_imu, const Matrix6d& covariance);
  /// The device is found elsewhere, or lost: pose and velocity are new, with a wide prior; biases and gravity
  /// stay.
  void place(const Pose& T_odom_imu, const Eigen::Vector3d& velocity_m_s, double velocity_sd_m_s);

  /// The pose stays where it is, though nobody knows whether the device does: its doubt goes on growing, by a
  /// speed of this deviation at least.
  void stop(double velocity_sd_m_s);
  /// What the measurements taught may be off by more than their covariance says: people that they followed, a
  /// map that errs. It shows when nothing is measured, and adds up with the time and with its square.
  void loosen(double velocity_sd_m_s, double accel_sd_m_s2);
  /// Adds to the pose's covariance, axes as `update` has them.
  void widen(const Matrix6d& covariance) { P_.topLeftCorner<6, 6>() += covariance; }

  /// How far the measurements of the last second were from the predictions, against what was expected: about 1.
  /// Where it is much more (a wrong mounting, wrong intrinsics), predictions are widened.
  [[nodiscard]] double strain() const { return expected_nis_ > 0 ? nis_ / expected_nis_ : 1; }
  [[nodiscard]] const InertialState& state() const { return state_; }
  /// Of the errors, in the order of the constants above.
  [[nodiscard]] const Matrix18d& covariance() const { return P_; }

 private:
  void apply(const Eigen::Matrix<double, 18, 1>& error);
  void forget(int block, double sd);
  void doubt(double seconds, double accel_sd_m_s2, double turn_sd_rad_s2);
  InertialState state_;
  Matrix18d P_ = Matrix18d::Zero();
  double unproven_ = 1;  ///< share of doubt in an IMU whose predictions have not come true yet
  double nis_ = 0,
         expected_nis_ = 0;  ///< normalized innovation squared, and its mean for a right model; both fade
};

}  // namespace liloc
