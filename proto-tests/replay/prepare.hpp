#pragma once
// What is checked and laid out before a replay starts, so that a bad recording costs nothing and leaves
// nothing.
#include "client/engine/engine.hpp"
#include "common/recording/recording.hpp"
#include "proto-tests/replay/options.hpp"

namespace liloc::replay {

/// Opens the recording with the chosen devices alone, and checks all that can be told without decoding a frame:
/// options, image formats and sizes, IMU, ground truth. Nothing is created. Errors name file, field and remedy.
[[nodiscard]] Result<Recording> open_for_replay(const ReplayOptions& options);

/// Makes OUT, or clears what an earlier replay left there. Error: it holds anything else.
[[nodiscard]] Status prepare_out(const std::filesystem::path& out);

/// What `device.json` tells a client: id, camera, how long it stands still; its IMU where `with_imu`.
[[nodiscard]] EngineOptions engine_options_of(const DeviceInfo& device, bool with_imu);

/// Name of the folder of a device's traces.
[[nodiscard]] std::filesystem::path trace_folder(const ReplayOptions& options, const std::string& device_id);

}  // namespace liloc::replay
