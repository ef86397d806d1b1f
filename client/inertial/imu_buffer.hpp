#pragma once
#include <deque>
#include <vector>

#include "client/inertial/inertial.hpp"

namespace liloc {

/// The newest samples of an IMU by rising stamp, each with the direction of gravity as it was known then. Not
/// thread-safe.
class ImuBuffer {
 public:
  struct Entry {
    ImuSample raw;       ///< as it came, in m/s^2
    Eigen::Vector3d up;  ///< unit vector against gravity, IMU axes; zero where it was not known
    bool stale = false;  ///< its force is an older message's, which stopped coming
  };
  /// What is taken off each sample to integrate it.
  struct Offsets {
    Eigen::Vector3d gyro_bias_rad_s;
    double gravity_m_s2;
  };

  /// Of samples that are older than the newest by more than `keep_seconds` none is kept.
  void add(Entry entry, double keep_seconds);
  void clear() { entries_.clear(); }
  /// The stamps were ahead by so much.
  void take_off(StampNs ahead_ns);
  /// The forces were in another unit.
  void scale_forces(double factor);
  /// "Up" is this at the newest sample, and turns back with the gyro.
  void set_up(const Eigen::Vector3d& up_imu, const Eigen::Vector3d& gyro_bias_rad_s);

  [[nodiscard]] bool empty() const { return entries_.empty(); }
  /// There must be one.
  [[nodiscard]] const Entry& newest() const { return entries_.back(); }
  /// The newest that is not newer than the stamp, or else the oldest. There must be one.
  [[nodiscard]] const Entry& at(StampNs stamp_ns) const;
  /// Some of what is kept is older and some newer.
  [[nodiscard]] bool surrounds(StampNs stamp_ns) const;
  /// True when samples surround the span closely enough to integrate over it.
  [[nodiscard]] bool covers(StampNs from_ns, StampNs to_ns) const;
  /// As they came; the first and the last lie at the span's ends. The span must be covered.
  [[nodiscard]] std::vector<ImuSample> samples(StampNs from_ns, StampNs to_ns) const;
  /// Less bias and gravity. The accelerations are smoothed by a Gaussian filter, then by a moving average,
  /// where `average_window` is not 0; both in samples. The span must be covered.
  [[nodiscard]] std::vector<InertialSample> span(StampNs from_ns, StampNs to_ns, const Offsets& offsets,
                                                 double gaussian_sd = 0, int average_window = 0) const;

 private:
  [[nodiscard]] std::size_t first_after(StampNs stamp_ns) const;

  std::deque<Entry> entries_;
};

}  // namespace liloc
