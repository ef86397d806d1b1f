#include "proto-tests/replay/replay.hpp"

#include <algorithm>

#include "proto-tests/replay/live.hpp"
#include "proto-tests/replay/lockstep.hpp"
#include "proto-tests/replay/prepare.hpp"

namespace liloc::replay {
namespace {

tl::unexpected<ReplayError> ended(Error error, bool bad_input) {
  return tl::unexpected(ReplayError{std::move(error), bad_input});
}

/// `folder` holds the frames, `kind` names them.
tl::unexpected<Error> none_used(const Recording& recording, const RunFacts& run, const char* folder,
                                const char* kind, std::size_t frames) {
  const std::string where = (recording.root / folder).string();
  const auto first = std::ranges::find_if(
      run.skipped, [&](const std::string& line) { return line.find(where) != std::string::npos; });
  return fail("{}: none of its {} {} frames could be used; the first: {}", recording.root.string(), frames,
              kind, first == run.skipped.end() ? "unknown" : *first);
}

/// A replay that could use no frame of any device, or none of the ceiling, has located nothing, however
/// smoothly it ran.
Status check_used(const Recording& recording, const RunFacts& run) {
  if (run.device_frames > 0 && run.device_frames_used == 0)
    return none_used(recording, run, "devices", "device", run.device_frames);
  if (run.ceiling_frames > 0 && run.ceiling_frames_used == 0)
    return none_used(recording, run, "global", "ceiling", run.ceiling_frames);
  return {};
}

}  // namespace

tl::expected<Report, ReplayError> replay(const ReplayOptions& options, const Progress& progress) {
  const auto recording = open_for_replay(options);
  if (!recording) return ended(recording.error(), true);
  if (auto status = prepare_out(options.out); !status) return ended(status.error(), true);

  const Stopwatch watch;
  Report report;
  auto run =
      options.lockstep ? run_lockstep(*recording, options, progress) : run_live(*recording, options, progress);
  if (!run) return ended(run.error(), false);
  report.run = std::move(*run);
  report.run.recording = std::filesystem::weakly_canonical(options.recording).filename();
  report.run.mode = options.lockstep ? "lockstep" : "dds";
  report.run.seed = options.seed;
  report.run.wall_s = watch.elapsed_ms() / 1e3;
  for (const DeviceRecording& device : recording->devices) {
    auto score = evaluate(*recording, device, trace_folder(options, device.info.id));
    if (!score) return ended(score.error(), false);
    report.devices.push_back(std::move(*score));
  }
  if (auto status = write_report(options.out / "report.json", report); !status)
    return ended(status.error(), false);
  if (const Status used = check_used(*recording, report.run); !used) return ended(used.error(), false);
  return report;
}

}  // namespace liloc::replay
