#include "proto-tests/bench/plan_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "common/codec/codec.hpp"
#include "common/geometry/depth.hpp"
#include "common/geometry/voxel.hpp"
#include "proto-tests/bench/spot_bench_row.hpp"
#include "proto-tests/sim/base/random.hpp"
#include "proto-tests/sim/reference_scan.hpp"
#include "proto-tests/sim/rig.hpp"
#include "proto-tests/sim/sensors/depth_sensor.hpp"
#include "proto-tests/sim/site/floor_plan.hpp"
#include "proto-tests/sim/world.hpp"
#include "server/localization/localizer.hpp"
#include "server/plan/coverage.hpp"

namespace liloc::bench {
namespace {

constexpr double kLearn_s = 3.05;         // until the ceiling knows what stands still
constexpr double kStep_s = 1;             // between moments that are asked at
constexpr double kBodyRadius_m = 0.38;    // as of everybody in the simulator
constexpr std::size_t kLpcPoints = 4000;  // as client/engine/request_maker.cpp
constexpr StampNs kStart = 1'700'000'000'000'000'000;

StampNs stamp_at(double time_s) {
  return kStart + from_seconds(time_s);
}

/// A site with people and no device of its own.
sim::SimOptions peopled(std::uint64_t seed, const PlanTrialOptions& options) {
  sim::SimOptions o = site_options(seed, options.seconds, options.style);
  o.devices = 0;
  return o;
}

class Server {
 public:
  Server(sim::World& world, const sim::SimOptions& options, const Site& site)
      : world_(world), options_(options), site_(site), cloud_(site, {}), localizer_(cloud_, {}) {}

  /// All ceiling frames up to a moment.
  [[nodiscard]] Status watch(double to_s) {
    for (; next_s() < to_s; ++ticks_)
      for (std::size_t i = 0; i < site_.global_lidars.size(); ++i) {
        const GlobalLidar& lidar = site_.global_lidars[i];
        const Status taken = cloud_.add_depth(i, sensed(next_s(), lidar.camera, lidar.T_map_sensor,
                                                        options_.lidar_range_m, options_.lidar_sensor));
        if (!taken) return taken;
      }
    cloud_.prepare();
    return {};
  }

  [[nodiscard]] Result<Row> ask(double time_s, const Camera& camera, const Pose& T_map_sensor) {
    const DepthImage image =
        sensed(time_s, camera, T_map_sensor, options_.device_range_m, options_.device_sensor);
    const auto cloud = depth_to_cloud(image, camera);
    if (!cloud) return tl::unexpected(cloud.error());
    SpotRequest request;
    request.client_id = fmt::format("device{}", frames_);
    request.stamp_ns = image.stamp_ns;
    request.cold = true;
    request.view.camera = camera;
    request.up_sensor = T_map_sensor.linear().transpose() * Eigen::Vector3d::UnitZ();
    const auto lpc = encode(voxel_downsample(*cloud, request.voxel_size_m, kLpcPoints));
    if (!lpc) return judged(refusal(request, Reason::bad_cloud, lpc.error().message), T_map_sensor);
    request.lpc = *lpc;
    return judged(localizer_.locate(request), T_map_sensor);
  }

 private:
  DepthImage sensed(double time_s, const Camera& camera, const Pose& T, double range_m,
                    sim::SensorModel model) {
    return sim::sense(world_.look(time_s, camera, T, range_m), {camera, 0.2, range_m, options_.noise, model},
                      sim::mix(sim::mix(options_.seed) + ++frames_), stamp_at(time_s));
  }

  [[nodiscard]] double next_s() const { return static_cast<double>(ticks_) / options_.lidar_rate_hz; }

  sim::World& world_;
  const sim::SimOptions& options_;
  const Site& site_;
  GlobalCloud cloud_;
  Localizer localizer_;
  std::uint64_t frames_ = 0;
  int ticks_ = 0;
};

struct Plan {
  plan::VoxelRoom room;
  plan::DeviceViews devices;
};

Result<Plan> look_around(const Cloud& scan, const Camera& camera, double range_m) {
  auto room = plan::VoxelRoom::create(scan);
  if (!room) return tl::unexpected(room.error());
  const auto floor = plan::find_free_floor(*room);
  if (!floor) return tl::unexpected(floor.error());
  plan::DeviceModel device;
  device.camera = camera;
  device.range_m = range_m;
  auto views = plan::look_around(*room, *floor, device, [](double) {});
  return Plan{std::move(*room), std::move(views)};
}

/// Poses to ask from: where furniture leaves room, and nobody is inside the wall that the scan did not show.
std::vector<std::size_t> drawn_views(const plan::DeviceViews& devices, const sim::Layout& layout, int count,
                                     std::uint64_t seed) {
  const sim::FloorPlan plan(layout, kBodyRadius_m);
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < devices.views.size(); ++i)
    if (plan.is_free(devices.views[i].T_map_sensor.translation().head<2>())) free.push_back(i);
  sim::Random random(seed, 901);
  std::vector<std::size_t> drawn;
  for (int i = 0; i < count && !free.empty(); ++i) {
    const auto at = static_cast<std::size_t>(random.below(static_cast<int>(free.size())));
    drawn.push_back(free[at]);
    free[at] = free.back();
    free.pop_back();
  }
  return drawn;
}

Result<std::vector<PlanRow>> ask_all(Server& server, const Plan& plan, const plan::Coverage& coverage,
                                     const std::vector<std::size_t>& views, const sim::SimOptions& options,
                                     const Camera& camera) {
  std::vector<PlanRow> rows;
  const auto moments = static_cast<std::size_t>((options.seconds - kLearn_s) / kStep_s);
  for (std::size_t moment = 0; moment < moments; ++moment) {
    const double now_s = kLearn_s + static_cast<double>(moment) * kStep_s;
    if (const Status seen = server.watch(now_s); !seen) return tl::unexpected(seen.error());
    for (std::size_t i = moment; i < views.size(); i += moments) {
      const auto row = server.ask(now_s, camera, plan.devices.views[views[i]].T_map_sensor);
      if (!row) return tl::unexpected(row.error());
      rows.push_back({options.seed, coverage.features(views[i]), coverage.chance(views[i]), row->reply.overlap,
                      row->reply.verified(), row->right()});
    }
  }
  return rows;
}

}  // namespace

double PlanTrial::mean_chance() const {
  double sum = 0;
  for (const PlanRow& row : rows) sum += row.chance;
  return rows.empty() ? 0 : sum / static_cast<double>(rows.size());
}

double PlanTrial::verified_share() const {
  const auto verified = std::ranges::count_if(rows, &PlanRow::verified);
  return rows.empty() ? 0 : static_cast<double>(verified) / static_cast<double>(rows.size());
}

Result<PlanTrial> run_plan_trial(std::uint64_t seed, const PlanTrialOptions& options) {
  const auto sim_options = peopled(seed, options).validated();
  if (!sim_options) return tl::unexpected(sim_options.error());
  auto world = sim::World::create(*sim_options);
  if (!world) return tl::unexpected(world.error());
  const auto scan = sim::scan_reference(world->layout(), 1);
  if (!scan) return tl::unexpected(scan.error());
  const Site site = sim::make_site(*sim_options, world->layout().size_m);
  const Camera camera = site.global_lidars.front().camera;
  const auto plan = look_around(*scan, camera, sim_options->device_range_m);
  if (!plan) return fail("seed {}: {}", seed, plan.error().message);
  plan::Coverage coverage(plan->room, plan->devices);
  for (const GlobalLidar& lidar : site.global_lidars)
    coverage.add(plan::SensorRays(lidar.camera, plan::kLidarRange_m).seen(plan->room, lidar.T_map_sensor));
  PlanTrial trial{fmt::format("{:.0f} m2, {} people, {} LiDARs", sim_options->width_m * sim_options->depth_m,
                              sim_options->people, sim_options->lidars),
                  seed,
                  coverage.localizable_share(),
                  coverage.covered_share(),
                  {}};
  Server server(*world, *sim_options, site);
  const auto views = drawn_views(plan->devices, world->layout(), options.poses, seed);
  auto rows = ask_all(server, *plan, coverage, views, *sim_options, camera);
  if (!rows) return tl::unexpected(rows.error());
  trial.rows = std::move(*rows);
  return trial;
}

Status write_plan_rows(const std::string& path, const std::vector<PlanTrial>& trials) {
  std::ofstream out(path);
  out << "seed,seen,covered,upright,weakest,strongest,alike,chance,overlap,verified,right\n";
  for (const PlanTrial& trial : trials)
    for (const PlanRow& r : trial.rows) {
      const plan::Support& s = r.features.support;
      out << fmt::format("{},{:.0f},{:.0f},{:.0f},{:.2f},{:.2f},{:.4f},{:.5f},{:.3f},{},{}\n", trial.seed,
                         r.features.seen, s.covered, s.upright, s.weakest(), s.xx + s.yy - s.weakest(),
                         r.features.alike, r.chance, r.overlap, r.verified ? 1 : 0, r.right ? 1 : 0);
    }
  if (!out.flush()) return fail("{}: cannot be written; name a file in a folder that exists", path);
  return {};
}

}  // namespace liloc::bench
