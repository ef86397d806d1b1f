#include "proto-tests/replay/lockstep.hpp"

#include <algorithm>
#include <ctime>
#include <limits>
#include <memory>
#include <optional>

#include "client/engine/engine.hpp"
#include "client/engine/trace.hpp"
#include "common/learned/describer.hpp"
#include "proto-tests/replay/prepare.hpp"
#include "proto-tests/replay/processes.hpp"
#include "proto-tests/replay/saved_answers.hpp"
#include "proto-tests/replay/timeline.hpp"
#include "server/localization/localizer.hpp"

namespace liloc::replay {
namespace {

constexpr StampNs kHold_ns = from_ms(100);  // longest wait for the ceiling; the server's --hold-ms

/// CPU time of the calling thread so far.
double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Device {
  explicit Device(EngineOptions options) : engine(std::move(options)) {}
  Engine engine;
  TraceWriter trace;
  std::deque<SpotRequest> held;  ///< asked, not yet answered; oldest first
  double cpu_s = 0;              ///< of the engine, which has no thread of its own
};

EngineOptions engine_options(const DeviceRecording& device, const ReplayOptions& options) {
  EngineOptions engine = engine_options_of(device.info, !device.imu.empty());
  engine.voxel_size_m = options.voxel_m;
  engine.interval_ns = from_ms(options.interval_ms);
  engine.searching_interval_ns = from_ms(options.searching_interval_ms);
  engine.local = *local_method_from(options.local);
  engine.cold = options.cold;
  engine.submap = options.submap;
  engine.codec = *codec_from(options.codec);
  engine.seed = options.seed;
  return engine;
}

Result<LocalizerOptions> localizer_options(const ReplayOptions& options) {
  LocalizerOptions localizer;
  localizer.method = *method_from(options.method);
  if (!options.verify.empty()) localizer.verify = *verify_from(options.verify);
  if (!options.icp.empty()) localizer.icp = *icp_from(options.icp);
  localizer.voxel_size_m = options.voxel_m;
  localizer.sampling = options.sampling;
  localizer.risk = options.risk;
  localizer.seed = options.seed;
  localizer.threads = options.threads;
  auto describer = learned::describer_from(options.features, options.weights, options.threads);
  if (!describer) return tl::unexpected(describer.error());
  localizer.describer = std::move(*describer);
  return localizer;
}

class Lockstep {
 public:
  Lockstep(const Recording& recording, const ReplayOptions& options, const LocalizerOptions& localizer)
      : recording_(recording),
        cloud_(recording.site, global_cloud_options_for(localizer)),
        localizer_(cloud_, localizer, {},
                   options.save_answers.empty() ? AnswerSink() : AnswerSink([this](const Answered& answered) {
                     saved_.take(answered);
                   })),
        newest_ceiling_ns_(recording.lidars.size(), std::numeric_limits<StampNs>::min()) {}

  Status open(const ReplayOptions& options) {
    if (auto opened = saved_.open(options.save_answers, recording_); !opened) return opened;
    for (const DeviceRecording& device : recording_.devices) {
      devices_.push_back(std::make_unique<Device>(engine_options(device, options)));
      if (auto status = devices_.back()->trace.open(trace_folder(options, device.info.id)); !status)
        return status;
    }
    return {};
  }

  Status step(const Event& event, FrameReader& frames) {
    answer_due(event.stamp_ns);
    switch (event.kind) {
      case Event::Kind::ceiling:
        add_ceiling(event, frames.next());
        break;
      case Event::Kind::imu:
        add_imu(event);
        break;
      case Event::Kind::device:
        return add_device(event, frames.next());
    }
    return {};
  }

  Status close() {
    answer_due(std::numeric_limits<StampNs>::max());
    if (auto status = saved_.status(); !status) return status;
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      facts.client_cpu_s[recording_.devices[i].info.id] = devices_[i]->cpu_s;
      if (auto status = devices_[i]->trace.close(); !status) return status;
    }
    return {};
  }

  RunFacts facts;

 private:
  void skip(const std::string& why) { facts.skipped.push_back(why); }

  void add_ceiling(const Event& event, Result<DepthImage> image) {
    ++facts.ceiling_frames;
    if (!image) return skip(image.error().message);
    if (auto status = cloud_.add_depth(event.source, std::move(*image)); !status)
      return skip(status.error().message);
    ++facts.ceiling_frames_used;
    newest_ceiling_ns_[event.source] = event.stamp_ns;
    answer_due(event.stamp_ns);
  }

  void add_imu(const Event& event) {
    const ImuSample& sample = recording_.devices[event.source].imu[event.index];
    Device& device = *devices_[event.source];
    const double before_s = thread_cpu_s();
    const Status status = device.engine.add_imu(sample);
    device.cpu_s += thread_cpu_s() - before_s;
    if (!status) skip(status.error().message);
  }

  Status add_device(const Event& event, const Result<DepthImage>& image) {
    ++facts.device_frames;
    if (!image) {
      skip(image.error().message);
      return {};
    }
    Device& device = *devices_[event.source];
    const double before_s = thread_cpu_s();
    const auto frame = device.engine.add_depth(*image);
    device.cpu_s += thread_cpu_s() - before_s;
    if (!frame) {
      skip(frame.error().message);
      return {};
    }
    ++facts.device_frames_used;
    if (auto status = device.trace.on_frame(*frame); !status) return status;
    if (auto request = device.engine.take_request()) {
      device.trace.on_request(*request);
      device.held.push_back(std::move(*request));
    }
    answer_due(event.stamp_ns);
    return {};
  }

  /// Answers what need not or must not wait longer, at recorded time `now_ns`.
  void answer_due(StampNs now_ns) {
    const auto oldest = std::min_element(newest_ceiling_ns_.begin(), newest_ceiling_ns_.end());
    // As in the server: a LiDAR whose last frame still counts for the stamp need not show a newer one.
    const auto all_seen = [&](StampNs stamp_ns) {
      return oldest == newest_ceiling_ns_.end() || *oldest >= stamp_ns - cloud_.match_ns();
    };
    for (auto& device : devices_)
      while (!device->held.empty()) {
        const SpotRequest& request = device->held.front();
        if (!all_seen(request.stamp_ns) && now_ns < request.stamp_ns + kHold_ns) break;
        cloud_.prepare();  // which the server does beside its requests
        const SpotReply reply = localizer_.locate(request);
        device->engine.add_reply(reply);
        device->trace.on_reply(reply);
        device->held.pop_front();
      }
  }

  const Recording& recording_;
  GlobalCloud cloud_;
  SavedAnswers saved_;
  Localizer localizer_;
  std::vector<std::unique_ptr<Device>> devices_;  ///< in the order of the recording
  std::vector<StampNs> newest_ceiling_ns_;        ///< per LiDAR
};

}  // namespace

Result<RunFacts> run_lockstep(const Recording& recording, const ReplayOptions& options,
                              const Progress& progress) {
  const std::vector<Event> events = timeline(recording);
  FrameReader frames(recording, events);
  const auto localizer = localizer_options(options);
  if (!localizer) return tl::unexpected(localizer.error());
  Lockstep lockstep(recording, options, *localizer);
  if (auto status = lockstep.open(options); !status) return tl::unexpected(status.error());
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (auto status = lockstep.step(events[i], frames); !status) return tl::unexpected(status.error());
    if (stop_requested()) return fail("replay: stopped by a signal at {} of {} events", i, events.size());
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(events.size()));
  }
  if (auto status = lockstep.close(); !status) return tl::unexpected(status.error());

  lockstep.facts.recorded_s = recorded_seconds(events);
  return std::move(lockstep.facts);
}

}  // namespace liloc::replay
