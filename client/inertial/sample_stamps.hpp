#pragma once
#include "common/base/stamp_watch.hpp"

namespace liloc {

// No IMU or odometry has 50 000 samples a second; a driver that stamps as it reads may have a USB packet of
// them that lie closer.
constexpr StampNs kClosestSampleNs = 20'000;  // 50 kHz: no such IMU is as quick; by hand
constexpr std::size_t kJudgedSamples = 20;    // by hand
constexpr StampNs kLargestGapNs =
    from_ms(50);  // between IMU samples that are integrated over: ten at 200 Hz; by hand

}  // namespace liloc
