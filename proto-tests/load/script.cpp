#include "proto-tests/load/script.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "client/engine/engine.hpp"
#include "proto-tests/replay/prepare.hpp"
#include "proto-tests/replay/processes.hpp"
#include "proto-tests/sim/simulation.hpp"

namespace liloc::load {
namespace {

sim::SimOptions site_options(const LoadOptions& options) {
  sim::SimOptions site;
  site.seed = options.seed;
  site.kind = options.kind;
  site.people = options.people;
  site.moved_items = site.pushed_items = 0;  // ways are walked to and fro, at any time
  site.lidars = options.lidars;
  site.lidar_rate_hz = options.lidar_rate_hz;
  site.devices = options.paths;
  site.device_rate_hz = 1 / kFrame_s;
  site.seconds = options.path_s;
  site.still_seconds = 1;
  return site;
}

/// A device's own client, which is told the truth whenever it asks.
class Author {
 public:
  Author(const DeviceInfo& device, const LoadOptions& options) : engine_(engine_options(device, options)) {}

  Status add(const ImuSample& sample) { return engine_.add_imu(sample); }

  Status add(const sim::DeviceFrame& frame) {
    const auto result = engine_.add_depth(frame.image);
    if (!result) return tl::unexpected(result.error());
    if (std::exchange(segment_, result->odom_segment) != result->odom_segment)
      for (ScriptFrame& before : path_) before = {before.T_map_sensor, result->T_odom_sensor, false, {}};
    ScriptFrame& made = path_.emplace_back();
    made.T_map_sensor = frame.T_map_sensor;
    made.T_odom_sensor = result->T_odom_sensor;
    made.informative = result->informative;
    made.request = engine_.take_request();
    if (!made.request) return {};
    SpotReply truth = refusal(*made.request, Reason::confirmed, "");
    truth.status = SpotStatus::verified;
    truth.T_map_sensor = frame.T_map_sensor;
    truth.T_map_odom = frame.T_map_sensor * result->T_odom_sensor.inverse();
    truth.confidence = 1;
    engine_.add_reply(truth);
    return {};
  }
  [[nodiscard]] Path take() { return std::move(path_); }

 private:
  static EngineOptions engine_options(const DeviceInfo& device, const LoadOptions& options) {
    EngineOptions engine = replay::engine_options_of(device, device.T_imu_sensor.has_value());
    engine.interval_ns = engine.searching_interval_ns = from_seconds(kFrame_s);
    engine.seed = options.seed;
    engine.codec = *codec_from(options.codec);
    return engine;
  }

  Engine engine_;
  std::uint32_t segment_ = 0;
  Path path_;
};

Status take(sim::SimEvent event, double at_s, std::vector<std::unique_ptr<Author>>& authors, Script& script) {
  if (auto* ceiling = std::get_if<sim::LidarFrame>(&event.payload)) {
    script.ceiling.push_back({at_s, ceiling->lidar, std::move(ceiling->image)});
    return {};
  }
  if (const auto* imu = std::get_if<sim::DeviceImu>(&event.payload))
    return authors[imu->device]->add(imu->sample);
  const auto& frame = std::get<sim::DeviceFrame>(event.payload);
  return authors[frame.device]->add(frame);
}

bool asks(const Path& path) {
  return std::ranges::any_of(path, [](const ScriptFrame& frame) { return frame.request.has_value(); });
}

}  // namespace

Result<Script> make_script(const LoadOptions& options, const std::function<void(double)>& progress) {
  auto simulation = sim::Simulation::create(site_options(options));
  if (!simulation) return tl::unexpected(simulation.error());
  Script script;
  script.site = simulation->site();
  script.seconds = options.path_s;
  std::vector<std::unique_ptr<Author>> authors;
  for (const DeviceInfo& device : simulation->devices())
    authors.push_back(std::make_unique<Author>(device, options));
  while (auto event = simulation->next()) {
    const double at_s = to_seconds(event->at_ns - simulation->start_ns());
    if (const Status ok = take(std::move(*event), at_s, authors, script); !ok)
      return tl::unexpected(ok.error());
    if (replay::stop_requested()) return fail("load: stopped by a signal");
    if (progress) progress(at_s / options.path_s);
  }
  for (auto& author : authors)
    if (Path path = author->take(); asks(path)) script.paths.push_back(std::move(path));
  if (script.paths.empty()) return fail("load: no simulated way gave a request; try another --seed");
  return script;
}

double to_and_fro(double travelled, double length) {
  if (length <= 0) return 0;
  const double within = std::fmod(travelled, 2 * length);
  return within <= length ? within : 2 * length - within;
}

}  // namespace liloc::load
