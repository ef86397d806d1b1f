#include "proto-tests/replay/replay.hpp"

#include "proto-tests/replay/live.hpp"
#include "proto-tests/replay/lockstep.hpp"
#include "proto-tests/replay/prepare.hpp"

namespace liloc::replay {
namespace {

tl::unexpected<ReplayError> ended(Error error, bool bad_input) {
  return tl::unexpected(ReplayError{std::move(error), bad_input});
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
  return report;
}

}  // namespace liloc::replay
