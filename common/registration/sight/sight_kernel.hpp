#pragma once
// What a depth sensor's lines of sight say of many points at once.
#include <cstddef>
#include <cstdint>

#include "common/registration/points/vectors.hpp"

namespace liloc {

/// A pinhole camera and where it stands, for a kernel. `R` by columns; `none`: a pixel that measured nothing.
struct Pinhole {
  float R[9], t[3], fx, fy, cx, cy, width, height, nearest;
  std::int32_t none;
};

/// The nearest and the farthest depth measured in a pixel, in metres; far 0: nothing measured. `edge`: the
/// nearest one in it or close by, at most `near`; what lies before that was looked through.
struct DepthBand {
  float near = 0, far = 0, edge = 0;
  bool operator==(const DepthBand&) const = default;
};

/// The weightier word wins: a surface that one sensor measured outweighs that another, past an edge, looked by.
enum Word : std::int32_t { kNoWord = 0, kLookedThrough = 1, kMeasured = 2 };

/// Raises each point's word to what the camera says of it: `SightView::look` for many points.
void look_at(const Pinhole& camera, const DepthBand* bands, const PointRun& points, float tolerance_m,
             std::int32_t* words);
/// The same of points that lie on surfaces with these unit normals, or zero where none is known. What is looked
/// through must also lie 5 cm before what was measured along its own normal: past a surface that a line of
/// sight grazes a sensor looks for want of a return, and where a centimetre is a metre along the line.
void look_at(const Pinhole& camera, const DepthBand* bands, const PointRun& points, const PointRun& normals,
             float tolerance_m, std::int32_t* words);

/// A half space that a ball must reach into: x * p.x + y * p.y + z * p.z + off > -radius. (x, y, z) is unit.
struct HalfSpace {
  float x, y, z, off;
};

/// Clears what is `reached` by a ball that misses one of the half spaces.
void reach_into(const HalfSpace* spaces, std::size_t space_count, const PointRun& centres, const float* radii,
                std::int32_t* reached);

}  // namespace liloc
