#pragma once
// Whether an IMU and registration tell the same motion, and if not, why. Pure functions.
#include "client/inertial/motion_record.hpp"

namespace liloc {

enum class Agreement { unknown, agrees, contradicts };

/// Of the gyro's rates with the rotation that was seen; unknown where the device hardly turned. `bias_rad_s`
/// is taken off the gyro.
[[nodiscard]] Agreement gyro_agreement(const MotionRecord& record, const Eigen::Vector3d& bias_rad_s);

/// Of the specific force with gravity: its mean over seconds, turned as registration saw it, is as large, and
/// stays where it is.
[[nodiscard]] Agreement force_agreement(const MotionRecord& record);
/// Of the force's sign with the accelerations that were seen: an inverted accelerometer feels as much gravity,
/// which stays where it is as well. Unknown where the device hardly accelerated.
[[nodiscard]] Agreement sign_agreement(const MotionRecord& record);
/// The mean of `force_agreement`, odometry axes; empty: not enough was seen and felt.
[[nodiscard]] std::optional<Eigen::Vector3d> mean_force_m_s2(const MotionRecord& record);

/// By how much the gyro's rates are larger than what was seen; empty: they are no multiple of it.
[[nodiscard]] std::optional<double> gyro_factor(const MotionRecord& record);

/// By how much the IMU's stamps are ahead of the frames', up to three seconds either way: where the rotations
/// of the last seconds fit best; empty: no place is right, or not more so than 0, or another is as right (the
/// motion repeats itself).
[[nodiscard]] std::optional<StampNs> stamps_ahead_ns(const MotionRecord& record);

}  // namespace liloc
