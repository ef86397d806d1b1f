#pragma once
#include "common/geometry/camera.hpp"

namespace liloc {

/// A frame taken apart. Where somebody's outline mixes with what is behind, and where a pixel stands alone
/// with what it says, it is in neither `still` nor `moving` (0). `moving` and `gone` may be empty: nothing.
struct Layers {
  DepthImage still, moving;
  DepthImage gone;  ///< of surfaces that were shown last and that this frame does not find any more
};

}  // namespace liloc
