#pragma once
// The kinds of depth sensor besides the default one. Each makes of a view what the real one would; `sense`
// chooses among them. Where their constants come from: SENSORS.md.
#include "proto-tests/sim/sensors/depth_sensor.hpp"

namespace liloc::sim {

/// A real L515: returns get rare with range, angle and towards the image's corners, and come in speckles.
[[nodiscard]] DepthImage sense_l515_real(const View& view, const DepthSensor& sensor, std::uint64_t key,
                                         StampNs stamp_ns);
/// Structured light: whole steps of disparity, no depth in the projector's shadow, frayed outlines.
[[nodiscard]] DepthImage sense_kinect(const View& view, const DepthSensor& sensor, std::uint64_t key,
                                      StampNs stamp_ns);
/// Time of flight: flying pixels, corners filled by light that bounced, a hexagonal image.
[[nodiscard]] DepthImage sense_tof(const View& view, const DepthSensor& sensor, std::uint64_t key,
                                   StampNs stamp_ns);

/// Depth as the sensor's unit holds it.
[[nodiscard]] inline std::uint16_t in_units(float depth_m, const Camera& camera) {
  const float units = depth_m * static_cast<float>(1.0 / camera.depth_scale_m) + 0.5F;
  return static_cast<std::uint16_t>(units < 0 ? 0.0F : units > 65535 ? 65535.0F : units);
}

}  // namespace liloc::sim
