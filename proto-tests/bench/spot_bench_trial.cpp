#include "proto-tests/bench/spot_bench_trial.hpp"

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <limits>

#include "client/engine/engine.hpp"
#include "common/codec/codec.hpp"
#include "common/registration/points/normals.hpp"
#include "common/registration/refine/pose_covariance.hpp"
#include "proto-tests/bench/spot_bench_misses.hpp"
#include "proto-tests/replay/prepare.hpp"
#include "proto-tests/replay/truth.hpp"
#include "server/localization/answered.hpp"
#include "server/localization/device_session.hpp"
#include "server/localization/localizer.hpp"
#include "server/localization/spot_solver.hpp"

namespace liloc::bench {
namespace {

constexpr StampNs kHold_ns = from_ms(100);  // longest wait for the ceiling; the server's --hold-ms
constexpr std::size_t kRecentFrames = 4;    // of a LiDAR, that show a request's overlap; by hand

struct Asked {
  SpotRequest request;
  DepthImage image;
  Pose T_map_sensor_true;
};

struct Device {
  explicit Device(EngineOptions options) : engine(std::move(options)) {}
  Engine engine;
  std::unique_ptr<DeviceSession> doubting;  ///< where evidence is gathered
  std::optional<StampNs> first_asked_ns;
  std::deque<Asked> held;  ///< not yet answered; oldest first
};

LocalizerOptions localizer_options(const TrialOptions& options) {
  LocalizerOptions localizer;
  localizer.threads = options.threads;
  return localizer;
}

/// Of a session that never believes what it finds.
LocalizerOptions doubting(LocalizerOptions options) {
  options.risk = -1;
  return options;
}

class Trial {
 public:
  Trial(const Stage& stage, const TrialOptions& options)
      : stage_(stage),
        options_(options),
        cloud_(stage.site, {}),
        server_options_(localizer_options(options)),
        localizer_(cloud_, server_options_),
        recent_(stage.site.global_lidars.size()) {
    for (const DeviceInfo& device : stage.devices) {
      devices_.push_back(std::make_unique<Device>(replay::engine_options_of(device, true)));
      devices_.back()->doubting = std::make_unique<DeviceSession>(doubting(server_options_));
    }
  }

  [[nodiscard]] Status take(sim::SimEvent event) {
    return std::visit([&](auto& payload) { return take(std::move(payload), event.at_ns); }, event.payload);
  }

  TrialResult finish() {
    answer_due(std::numeric_limits<StampNs>::max());
    return std::move(result_);
  }

 private:
  Status take(sim::LidarFrame frame, StampNs at_ns) {
    auto& recent = recent_[frame.lidar];
    recent.push_back(frame.image);
    if (recent.size() > kRecentFrames) recent.pop_front();
    if (auto taken = cloud_.add_depth(frame.lidar, std::move(frame.image)); !taken) return taken;
    answer_due(at_ns);
    return {};
  }

  Status take(const sim::DeviceImu& imu, StampNs) { return devices_[imu.device]->engine.add_imu(imu.sample); }

  Status take(sim::DeviceFrame frame, StampNs at_ns) {
    Device& device = *devices_[frame.device];
    if (auto placed = device.engine.add_depth(frame.image); !placed) return tl::unexpected(placed.error());
    if (auto request = device.engine.take_request()) {
      if (!options_.gravity) request->up_sensor.reset();
      device.held.push_back({std::move(*request), std::move(frame.image), frame.T_map_sensor});
    }
    answer_due(at_ns);
    return {};
  }

  /// Answers what, as in the server, need not or must not wait longer for the ceiling.
  void answer_due(StampNs now_ns) {
    const auto all_seen = [&](StampNs stamp_ns) {
      return std::ranges::all_of(recent_, [&](const auto& frames) {
        return !frames.empty() && frames.back().stamp_ns >= stamp_ns - cloud_.match_ns();
      });
    };
    for (std::size_t i = 0; i < devices_.size(); ++i)
      while (!devices_[i]->held.empty()) {
        const Asked& asked = devices_[i]->held.front();
        if (!all_seen(asked.request.stamp_ns) && now_ns < asked.request.stamp_ns + kHold_ns) break;
        answer(asked, i);
        devices_[i]->held.pop_front();
      }
  }

  void answer(const Asked& asked, std::size_t device) {
    const double overlap = overlap_of(asked, stage_.devices[device].camera);
    const double before_ms = thread_cpu_ms();
    cloud_.prepare();  // which the server does beside its requests
    prepare_ms_ = thread_cpu_ms() - before_ms;
    SpotRequest alone = asked.request;
    alone.cold = true;
    alone.extra.bytes.clear();
    Device& d = *devices_[device];
    if (options_.peer_every > 0 && spots_++ % options_.peer_every == 0) keep_for_peers(asked, overlap);
    const double cold_ms = thread_cpu_ms();
    SpotReply cold = options_.evidence ? weighed(alone, d, overlap, asked) : localizer_.locate(alone);
    const double live_ms = thread_cpu_ms();
    SpotReply live =
        options_.evidence ? weighed(asked.request, d, overlap, asked) : localizer_.locate(asked.request);
    const double done_ms = thread_cpu_ms();
    d.engine.add_reply(live);
    truth_ = judged_at_truth(asked);
    add_row(std::move(cold), true, live_ms - cold_ms, overlap, asked);
    if (!result_.rows.empty() && result_.rows.back().cold) result_.rows.back().miss = missed(alone, asked);
    add_row(std::move(live), false, done_ms - live_ms, overlap, asked);
  }

  /// The very clouds that the localizer compares.
  void keep_for_peers(const Asked& asked, double overlap) {
    const auto snapshot = cloud_.nearest(asked.request.match_stamp_ns());
    const auto lpc = decode(asked.request.lpc);
    if (!snapshot || !lpc) return;
    result_.problems.push_back({with_normals(*lpc, Eigen::Vector3f::Zero()), (*snapshot)->target()->cloud,
                                asked.T_map_sensor_true, overlap, result_.rows.size()});
  }

  /// The answer of a session that believes nothing; what it rests on is kept.
  SpotReply weighed(const SpotRequest& request, Device& device, double overlap, const Asked& asked) {
    const auto snapshot = cloud_.nearest(request.match_stamp_ns());
    if (!snapshot) return refusal(request, Reason::no_gpc, snapshot.error().message);
    const auto spot = spot_of(*device.doubting, request, *snapshot, server_options_);
    if (!spot) return refusal(request, Reason::bad_cloud, spot.error().message);
    if (!device.first_asked_ns) device.first_asked_ns = request.stamp_ns;
    SpotReply reply = refusal(request, Reason::none, "");
    Evidence evidence = device.doubting->answer(*spot, true, &reply);
    for (std::size_t i = 1; i < evidence.places.size(); ++i) {
      const Pose& T = evidence.T_map_sensors[i];
      evidence.places[i].sd_m =
          PoseEstimate{T, pose_covariance((*spot)->problem().target, (*spot)->query(), T)}.sd_m();
    }
    std::vector<bool> right = against_truth(evidence, asked.T_map_sensor_true);
    result_.evidence.push_back({stage_.name, request.client_id, stage_.seed, request.cold,
                                to_seconds(request.stamp_ns - *device.first_asked_ns), overlap,
                                std::move(right), std::move(evidence)});
    return reply;
  }

  void add_row(SpotReply reply, bool cold, double cpu_ms, double overlap, const Asked& asked) {
    if (reply.reason == Reason::no_gpc || reply.reason == Reason::bad_cloud) return;
    Row row = judged(std::move(reply), asked.T_map_sensor_true);
    row.site = stage_.name;
    row.seed = stage_.seed;
    row.cold = cold;
    row.cpu_ms = cpu_ms;
    row.prepare_ms = prepare_ms_;
    row.overlap = overlap;
    row.conflict_truth = truth_.conflict;
    row.map_conflict_truth = truth_.map_conflict;
    result_.rows.push_back(std::move(row));
  }

  /// Of the newest row.
  [[nodiscard]] Miss missed(const SpotRequest& request, const Asked& asked) {
    const auto snapshot = cloud_.nearest(request.match_stamp_ns());
    if (!snapshot || !result_.rows.back().reply.T_map_sensor) return Miss::none;
    const auto spot = Spot::create(request, *snapshot, server_options_);
    if (!spot) return Miss::none;
    return miss_of((*spot)->problem(), *result_.rows.back().reply.T_map_sensor, asked.T_map_sensor_true);
  }

  [[nodiscard]] Judgement judged_at_truth(const Asked& asked) {
    const auto snapshot = cloud_.nearest(asked.request.match_stamp_ns());
    if (!snapshot) return {};
    const auto spot = Spot::create(asked.request, *snapshot, server_options_);
    if (!spot) return {};
    const SpotProblem& problem = (*spot)->problem();
    return judge(problem.target, problem.query, problem.query.medium, asked.T_map_sensor_true,
                 problem.judging.fine_tolerance_m);
  }

  [[nodiscard]] double overlap_of(const Asked& asked, const Camera& camera) const {
    std::vector<replay::PlacedFrame> ceiling;
    const auto age = [&](const DepthImage& image) {
      return std::llabs(image.stamp_ns - asked.request.stamp_ns);
    };
    for (std::size_t i = 0; i < recent_.size(); ++i) {
      const auto nearest = std::ranges::min_element(recent_[i], {}, age);
      if (nearest == recent_[i].end() || age(*nearest) > cloud_.match_ns()) continue;
      const GlobalLidar& lidar = stage_.site.global_lidars[i];
      ceiling.push_back({*nearest, lidar.camera, lidar.T_map_sensor});
    }
    return replay::overlap_at_truth(ceiling, {asked.image, camera, asked.T_map_sensor_true});
  }

  const Stage& stage_;
  const TrialOptions options_;
  GlobalCloud cloud_;
  const LocalizerOptions server_options_;
  Localizer localizer_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<std::deque<DepthImage>> recent_;  ///< per LiDAR, newest last
  TrialResult result_;
  double prepare_ms_ = 0;  ///< of the newest spot
  int spots_ = 0;
  Judgement truth_;  ///< of the newest spot
};

}  // namespace

Result<TrialResult> run_trial(Stage stage, const TrialOptions& options) {
  Trial trial(stage, options);
  while (auto event = stage.next())
    if (const Status taken = trial.take(std::move(*event)); !taken) return tl::unexpected(taken.error());
  return trial.finish();
}

}  // namespace liloc::bench
