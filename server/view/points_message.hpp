#pragma once
// Points for the page, six bytes each. Little-endian, as all of it:
//
//   0 u8 kind   1 u8 layout, 1   2 u16 0   4 u32 count   8 f32[3] low_m   20 f32[3] step_m   32 u16[3] each
//   point
//
// A point in the map frame is low_m + step_m * numbers: a 20 m room is told to 0.3 mm.
#include <cstdint>
#include <span>
#include <string>

#include "common/geometry/cloud.hpp"

namespace liloc::view {

enum class Points : std::uint8_t { room = 1, moving = 2, scan = 3 };

/// By hand: 1.2 MB, so that a viewer that holds two of them stays far below 8 MB.
constexpr std::size_t kMostPoints = 200'000;

/// All clouds as one; every n-th point where there are more than kMostPoints. What is not finite is left out.
[[nodiscard]] std::string points_message(Points kind, std::span<const Cloud* const> clouds_map);

}  // namespace liloc::view
