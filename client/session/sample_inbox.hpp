#pragma once
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "client/engine/engine.hpp"

namespace liloc {

/// IMU and odometry samples on their way from the callers' threads to the engine, which takes them before each
/// frame. Bounded: while no frame comes the oldest make room. Thread-safe.
class SampleInbox {
 public:
  struct Samples {
    std::deque<ImuSample> imu;
    std::deque<OdometrySample> odometry;
  };

  void add(const ImuSample& sample);
  void add(const OdometrySample& sample);
  /// All that has come since the last call, in the order of coming.
  [[nodiscard]] Samples take();
  /// Waits for odometry of `stamp_ns` or newer: a pose between two samples is better than one guessed beyond
  /// the newest. At once where no odometry ever came, and after `close`.
  void await_odometry(StampNs stamp_ns, std::chrono::milliseconds at_most);
  void close();

 private:
  std::mutex mutex_;
  std::condition_variable odometry_came_;
  Samples samples_;
  StampNs newest_odometry_ns_ = 0;
  bool closed_ = false;
};

}  // namespace liloc
