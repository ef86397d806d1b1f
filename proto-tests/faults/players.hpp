#pragma once
// Who plays the world in processes of their own: the ceiling LiDARs, and a device with the client library.
#include <chrono>
#include <string_view>
#include <vector>

#include "common/recording/recording.hpp"
#include "common/wire/dds/participant.hpp"

namespace liloc::faults {

/// What the sensors themselves do wrong; seconds since the start of the streams.
struct StreamFaults {
  std::vector<std::size_t> silent_lidars;     ///< send nothing ...
  double silent_from_s = 0, silent_to_s = 0;  ///< ... meanwhile
  double device_step_s = 0,
         ceiling_step_s = 0;  ///< the clock of all devices, of all LiDARs, is set by so much ...
  double step_at_s = 0;       ///< ... at this moment
};

/// One scenario's part of a recording, played at its own speed.
struct Performance {
  const Recording& recording;
  std::chrono::steady_clock::time_point start;  ///< when the recording's first frame is due
  double seconds = 0;                           ///< of the recording
  StreamFaults faults;

  [[nodiscard]] double now_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
};

/// A reply that counted, as the device took it.
struct ReplyRow {
  double at_s = 0, frame_s = 0;          ///< when it came; when its frame was taken
  bool verified = false, wrong = false;  ///< wrong: verified, and off by more than 10 degrees or 0.3 m
};

/// A frame as the device told it.
struct FrameRow {
  double frame_s = 0;
  bool located = false, lost = false;  ///< has a pose; says that it is lost
  double error_m = 0, error_deg = 0;   ///< of that pose
};

struct DeviceStory {
  std::vector<ReplyRow> replies;
  std::vector<FrameRow> frames;
  std::uint64_t requests = 0, unsent = 0, unanswered = 0;
};

/// Streams the ceiling's frames until the performance is over or a stop signal. Errors: DDS.
[[nodiscard]] Result<std::string> play_ceiling(const Performance& performance, const wire::DomainOptions& seat);

/// Is the recording's first device: pushes its frames into a client, which leaves its traces and its log in
/// `out`, and hands back a DeviceStory as bytes. Errors: DDS, no ground truth.
[[nodiscard]] Result<std::string> play_device(const Performance& performance, const wire::DomainOptions& seat,
                                              const std::filesystem::path& out);

/// Of bytes of `play_device`, in this program's own layout.
[[nodiscard]] DeviceStory story_from(std::string_view bytes);

}  // namespace liloc::faults
