#pragma once
// The device of `common/testing/walk.hpp` as an engine.
#include "client/engine/engine.hpp"
#include "common/testing/walk.hpp"

namespace liloc::test {

inline EngineOptions engine_options() {
  EngineOptions options;
  options.client_id = "walker";
  options.camera = scene::small_camera();
  return options;
}

}  // namespace liloc::test
