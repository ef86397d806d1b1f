#include "proto-tests/replay/live.hpp"

#include <thread>

#include "proto-tests/replay/fleet.hpp"
#include "proto-tests/replay/prepare.hpp"
#include "proto-tests/replay/streams.hpp"
#include "proto-tests/replay/timeline.hpp"

namespace liloc::replay {
namespace {

using Clock = std::chrono::steady_clock;

FleetCommand fleet_command(const Recording& recording, const ReplayOptions& options, int domain) {
  FleetCommand fleet;
  fleet.programs = options.programs;
  fleet.domain = domain;
  fleet.site_file = recording.root / "site.json";
  fleet.server_log = options.out / "server.log";
  const std::string voxel = fmt::format("{}", options.voxel_m), seed = fmt::format("{}", options.seed);
  fleet.server_arguments = {"--voxel",    voxel,
                            "--method",   options.method,
                            "--seed",     seed,
                            "--sampling", fmt::format("{}", options.sampling),
                            "--risk",     fmt::format("{}", options.risk)};
  fleet.server_arguments.insert(fleet.server_arguments.end(),
                                {"--state", "none"});  // nothing from earlier replays
  if (options.features != "fpfh")
    fleet.server_arguments.insert(fleet.server_arguments.end(),
                                  {"--features", options.features, "--weights", options.weights.string()});
  for (const auto& [name, value] : {std::pair{"--verify", options.verify}, std::pair{"--icp", options.icp},
                                    std::pair{"--save-answers", options.save_answers}})
    if (!value.empty()) fleet.server_arguments.insert(fleet.server_arguments.end(), {name, value});
  for (const DeviceRecording& device : recording.devices) {
    ClientCommand client{
        device.info.id, device.folder / "device.json", trace_folder(options, device.info.id), {}};
    client.arguments = {"--voxel",
                        voxel,
                        "--interval-ms",
                        fmt::format("{}", options.interval_ms),
                        "--searching-interval-ms",
                        fmt::format("{}", options.searching_interval_ms),
                        "--local",
                        options.local,
                        "--codec",
                        options.codec,
                        "--seed",
                        seed};
    if (options.cold) client.arguments.emplace_back("--cold");
    if (!options.submap) client.arguments.emplace_back("--no-submap");
    fleet.clients.push_back(std::move(client));
  }
  return fleet;
}

std::vector<DeviceInfo> device_infos(const Recording& recording) {
  std::vector<DeviceInfo> infos;
  for (const DeviceRecording& device : recording.devices) infos.push_back(device.info);
  return infos;
}

Status send(const Streams& streams, const Recording& recording, const Event& event, FrameReader& frames,
            RunFacts& facts) {
  if (event.kind == Event::Kind::imu)
    return streams.imu(event.source, recording.devices[event.source].imu[event.index]);
  const bool ceiling = event.kind == Event::Kind::ceiling;
  ++(ceiling ? facts.ceiling_frames : facts.device_frames);
  const auto image = frames.next();
  if (!image) {
    facts.skipped.push_back(image.error().message);
    return {};
  }
  ++(ceiling ? facts.ceiling_frames_used : facts.device_frames_used);
  return ceiling ? streams.ceiling(event.source, *image) : streams.device(event.source, *image);
}

/// Sleeps until `due`, a little at a time, so that a signal or a dead child is noticed.
Status sleep_until(Clock::time_point due, Fleet& fleet) {
  constexpr auto kLook = std::chrono::milliseconds(50);  // by hand: a stop seems at once
  for (;;) {
    if (stop_requested()) return fail("replay: stopped by a signal");
    const auto now = Clock::now();
    if (now >= due) return {};
    if (due - now > kLook / 10)
      if (auto status = fleet.check(); !status) return status;
    std::this_thread::sleep_for(std::min<Clock::duration>(due - now, kLook));
  }
}

Status stream_all(const Recording& recording, const std::vector<Event>& events, const Streams& streams,
                  Fleet& fleet, RunFacts& facts, const Progress& progress) {
  FrameReader frames(recording, events);
  const auto start = Clock::now();
  for (std::size_t i = 0; i < events.size(); ++i) {
    const auto due = start + std::chrono::nanoseconds(events[i].due_ns - events.front().due_ns);
    if (auto status = sleep_until(due, fleet); !status) return status;
    if (auto status = send(streams, recording, events[i], frames, facts); !status) return status;
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(events.size()));
  }
  return sleep_until(Clock::now() + std::chrono::milliseconds(1500), fleet);  // the last answers
}

}  // namespace

Result<RunFacts> run_live(const Recording& recording, const ReplayOptions& options, const Progress& progress) {
  const std::vector<Event> events = timeline(recording, from_ms(options.clock_ahead_ms));
  RunFacts facts;
  const auto domain = free_domain();
  if (!domain) return tl::unexpected(domain.error());
  wire::DomainOptions seat;
  seat.domain = *domain;
  seat.role = wire::Role::source;
  auto participant = wire::Participant::create(seat);
  if (!participant) return tl::unexpected(participant.error());
  auto streams = Streams::create(*participant, recording.site, device_infos(recording));
  if (!streams) return tl::unexpected(streams.error());

  auto fleet = Fleet::start(fleet_command(recording, options, *domain));
  if (!fleet) return tl::unexpected(fleet.error());
  Status status = fleet->wait_until([&] { return streams->all_heard(); }, std::chrono::seconds(20),
                                    "server and clients listening to the streams");
  if (status) status = stream_all(recording, events, *streams, *fleet, facts, progress);
  const Status stopped = fleet->stop();
  if (!status) return tl::unexpected(status.error());
  if (!stopped) return tl::unexpected(stopped.error());

  facts.recorded_s = recorded_seconds(events);
  for (std::size_t i = 0; i < fleet->client_usage().size(); ++i) {
    const std::string& id = recording.devices[i].info.id;
    facts.client_cpu_s[id] = fleet->client_usage()[i].cpu_s;
    facts.client_peak_mb[id] = fleet->client_usage()[i].peak_mb;
  }
  return facts;
}

}  // namespace liloc::replay
