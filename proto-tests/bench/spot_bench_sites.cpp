#include "proto-tests/bench/spot_bench_sites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "proto-tests/replay/timeline.hpp"
#include "proto-tests/replay/truth.hpp"
#include "proto-tests/sim/base/random.hpp"

namespace liloc::bench {
namespace {

using sim::SiteKind;

// By hand: sites that are covered well, and a corridor that two people pass each other in.
constexpr double kFloorPerLidar_m2 = 25, kNarrowest_m = 2.2;
// World 2 as recordings/hall-sparse (48 m2 a LiDAR) and hall-crowded (35): offices and halls, two to four.
constexpr double kOtherLow_m2 = 30, kOtherHigh_m2 = 60;

struct KindOfSite {
  SiteKind kind;
  const char* name;
  double low_m2, high_m2;        ///< of the floor
  double low_ratio, high_ratio;  ///< of its length to its width
};
constexpr KindOfSite kOffice{SiteKind::office, "office", 40, 150, 1, 1.7},
    kCorridor{SiteKind::corridor, "corridor", 40, 80, 7, 11}, kHall{SiteKind::area, "hall", 150, 400, 1, 2},
    kSymmetric{SiteKind::symmetric, "symmetric", 50, 150, 1, 1.7};
constexpr std::array kKinds{kOffice, kOffice, kHall,      kCorridor, kOffice,
                            kHall,   kOffice, kSymmetric, kCorridor, kOffice};

/// A recording's frames and samples, one after the other; a damaged frame is left out.
struct Reader {
  Recording recording;
  std::vector<replay::Truth> truths;
  std::vector<replay::Event> events;
  std::size_t at = 0;
  std::optional<replay::FrameReader> frames;  // last: its thread looks at the others

  std::optional<sim::SimEvent> next() {
    while (at < events.size()) {
      const replay::Event& event = events[at++];
      if (event.kind == replay::Event::Kind::imu)
        return sim::SimEvent{event.due_ns,
                             sim::DeviceImu{event.source, recording.devices[event.source].imu[event.index]}};
      auto image = frames->next();
      if (!image) continue;
      if (event.kind == replay::Event::Kind::ceiling)
        return sim::SimEvent{event.due_ns, sim::LidarFrame{event.source, std::move(*image)}};
      return sim::SimEvent{event.due_ns, sim::DeviceFrame{event.source, std::move(*image),
                                                          truths[event.source].pose(event.index)}};
    }
    return std::nullopt;
  }
};

}  // namespace

sim::SimOptions site_options(std::uint64_t seed, double seconds, const SiteStyle& style) {
  const KindOfSite& kind = kKinds[seed % kKinds.size()];
  sim::Random random(seed, 900);
  sim::SimOptions o;
  o.seed = 1000 + seed;
  o.kind = kind.kind;
  const double floor_m2 = random.uniform(kind.low_m2, kind.high_m2);
  const double ratio = random.uniform(kind.low_ratio, kind.high_ratio);
  o.width_m = std::sqrt(floor_m2 * ratio);
  o.depth_m = std::max(floor_m2 / o.width_m, kNarrowest_m);
  o.clutter = random.uniform(0.3, 1.5);
  o.people = std::min(random.below(13), static_cast<int>(floor_m2 / 6));
  o.lidars = std::clamp(static_cast<int>(std::lround(floor_m2 / kFloorPerLidar_m2)), 3, 8);
  o.devices = 1;
  o.device_kind = random.chance(0.25) ? sim::DeviceKind::robot : sim::DeviceKind::carried;
  o.seconds = seconds;
  o.still_seconds = 1;
  o.world = style.world;
  o.lidar_sensor = style.lidar_sensor;
  o.device_sensor = style.device_sensor;
  if (o.world == 2) {
    const double each_m2 = random.uniform(kOtherLow_m2, kOtherHigh_m2);
    o.lidars = std::clamp(static_cast<int>(std::lround(floor_m2 / each_m2)), 2, 4);
    o.clutter = random.uniform(0.15, 2.0);
  }
  return o;
}

Result<Stage> simulated_stage(std::uint64_t seed, double seconds, const SiteStyle& style) {
  const sim::SimOptions options = site_options(seed, seconds, style);
  auto created = sim::Simulation::create(options);
  if (!created) return tl::unexpected(created.error());
  auto simulation = std::make_shared<sim::Simulation>(std::move(*created));
  return Stage{
      fmt::format("{} {:.0f} m2, {} people, clutter {:.1f}, {} LiDARs", kKinds[seed % kKinds.size()].name,
                  options.width_m * options.depth_m, options.people, options.clutter, options.lidars),
      seed, simulation->site(), simulation->devices(), [simulation] { return simulation->next(); }};
}

Result<Stage> recorded_stage(const std::string& folder) {
  auto recording = open_recording(folder);
  if (!recording) return tl::unexpected(recording.error());
  auto reader = std::make_shared<Reader>();
  std::erase_if(recording->devices, [](const DeviceRecording& device) {
    const auto truth = read_ground_truth(device);
    return truth && truth->empty();
  });
  if (recording->devices.empty()) return fail("{}: no device has a groundtruth.tum to judge by", folder);
  reader->recording = std::move(*recording);
  Stage stage{reader->recording.root.filename().string(), 0, reader->recording.site, {}, {}};
  for (const DeviceRecording& device : reader->recording.devices) {
    auto truth = replay::Truth::of(device);
    if (!truth) return tl::unexpected(truth.error());
    reader->truths.push_back(std::move(*truth));
    stage.devices.push_back(device.info);
    if (device.imu.empty()) stage.devices.back().T_imu_sensor.reset();
  }
  reader->events = replay::timeline(reader->recording);
  reader->frames.emplace(reader->recording, reader->events);
  stage.next = [reader] { return reader->next(); };
  return stage;
}

}  // namespace liloc::bench
