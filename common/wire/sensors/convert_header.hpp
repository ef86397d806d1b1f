#pragma once
// Private to the room: what all of ROS 2's sensor messages have in common.
#include <ros2.h>

#include <array>
#include <bit>
#include <cstdint>

#include "common/base/stamp.hpp"
#include "common/wire/dds/convert.hpp"

namespace liloc::wire {

static_assert(std::endian::native == std::endian::little, "samples are sent as they lie in memory");

inline Result<StampNs> stamp_of(const std_msgs_msg_dds__Header_& header) {
  if (header.stamp.sec < 0 || header.stamp.nanosec >= 1'000'000'000U)
    return fail("header.stamp is {} s {} ns, must not be negative, with less than 1e9 ns", header.stamp.sec,
                header.stamp.nanosec);
  return StampNs{header.stamp.sec} * 1'000'000'000 + header.stamp.nanosec;
}

/// A number as it lies in a message's bytes.
template <class T>
T load(const std::uint8_t* from, bool big_endian) {
  std::array<std::uint8_t, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (big_endian) std::ranges::reverse(bytes);
  return std::bit_cast<T>(bytes);
}

}  // namespace liloc::wire
