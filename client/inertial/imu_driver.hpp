#pragma once
// What drivers do to the samples of an IMU, and how it is undone.
#include <string>

#include "common/geometry/camera.hpp"

namespace liloc {

inline constexpr double kStandardGravity = 9.80665;  ///< m/s^2, by definition (CGPM 1901)

/// What unit an accelerometer's numbers have, by the mean of the first: some drivers send g, some convert
/// twice. Not thread-safe.
class ForceUnit {
 public:
  /// Of each sample as it came; zeros, which no accelerometer measures, tell nothing. True once, where the
  /// numbers turn out to be no m/s^2: those before this one are to be scaled.
  [[nodiscard]] bool learn(const Eigen::Vector3d& force);
  /// That turns the numbers into m/s^2.
  [[nodiscard]] double factor() const { return factor_; }
  /// For people; empty: nothing was noticed.
  [[nodiscard]] std::string problem() const;

 private:
  double factor_ = 1, sum_ = 0;
  int count_ = 0;
};

/// Drivers with a message for each sensor of an IMU fill the other's part with zeros, which no accelerometer
/// measures: a gyro's sample gets the newest force. Not thread-safe.
class SplitMessages {
 public:
  struct Merged {
    bool whole = true;         ///< false: it was an accelerometer's, and that is all it tells
    bool force_clips = false;  ///< of such a one: it is at the end of its range
  };
  /// Of each sample as it came, whose stamp is ahead by `ahead_ns`; `unit` turns its force into m/s^2.
  [[nodiscard]] Merged merge(ImuSample& sample, StampNs ahead_ns, double unit);

  /// The newest sample had zeros for the accelerometer.
  [[nodiscard]] bool now() const { return now_; }
  /// Of the newest sample, at that stamp: its force is an older message's, as no newer ones come.
  [[nodiscard]] bool stale(StampNs stamp_ns) const;
  /// It has been so for a while, and still is.
  [[nodiscard]] bool persist(StampNs now_ns) const;
  /// Of the newest force; 0: none was told.
  [[nodiscard]] StampNs force_ns() const { return force_ns_; }

  /// The stamps so far were ahead by so much.
  void take_off(StampNs ahead_ns);
  /// The IMU's clock was set: stamps of before say nothing any more.
  void clock_set() { force_ns_ = 0; }

 private:
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();  ///< newest that was told, as it came
  StampNs force_ns_ = 0;
  StampNs since_ns_ = 0, newest_ns_ = 0;  ///< of samples with zeros for the accelerometer
  bool now_ = false;
};

}  // namespace liloc
