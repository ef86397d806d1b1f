#include "proto-tests/sim/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "proto-tests/sim/reference_scan.hpp"
#include "proto-tests/sim/rig.hpp"
#include "proto-tests/sim/sensors/depth_sensor.hpp"
#include "proto-tests/sim/world.hpp"

namespace liloc::sim {
namespace {

constexpr StampNs kEpochNs = 1'700'000'000'000'000'000;  // of seed 0: a date in 2023, as sensors stamp
constexpr double kFirstDeviceFrame_s = 0.05;             // a ceiling frame is there before it
constexpr double kLidarJitter_s = 0.002;                 // most that a frame is off its period; by hand

enum class Source { lidar, device, imu };

/// One sensor's clockwork.
struct Stream {
  Source source;
  std::size_t index;
  double first_s, period_s;
  std::uint64_t count = 0;

  [[nodiscard]] double next_s() const {
    const std::uint64_t draw = mix(mix(index + 1) ^ count);  // LiDARs are not quite even
    const double jitter =
        source == Source::lidar ? kLidarJitter_s * (static_cast<double>(draw >> 11) * 0x1.0p-52 - 1) : 0;
    return first_s + static_cast<double>(count) * period_s + jitter;
  }
};

bool during(double time_s, double from_s, double length_s) {
  return time_s >= from_s && time_s < from_s + length_s;
}

}  // namespace

struct Simulation::Impl {
  Impl(SimOptions validated_options, World drawn)
      : options(std::move(validated_options)), world(std::move(drawn)) {}

  [[nodiscard]] DepthImage render(double time_s, const Camera& camera, const Pose& T_map_camera, double range_m,
                                  SensorModel model, bool covered, std::uint64_t key, StampNs stamp_ns) {
    View view = world.look(time_s, camera, T_map_camera, range_m);
    if (covered) cover_by_hand(view, camera, time_s);
    return sense(view, {camera, 0.2, range_m, options.noise, model}, key, stamp_ns);
  }
  [[nodiscard]] std::optional<SimEvent> emit(const Stream& stream, double time_s);

  SimOptions options;
  World world;
  Site site;
  std::vector<DeviceInfo> devices;
  std::vector<ImuErrors> imu_errors;
  std::vector<Stream> streams;
  StampNs start_ns = 0;
};

Simulation::Simulation(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Result<Simulation> Simulation::create(const SimOptions& asked) {
  const auto options = asked.validated();
  if (!options) return tl::unexpected(options.error());
  auto world = World::create(*options);
  if (!world) return tl::unexpected(world.error());
  auto impl = std::make_unique<Impl>(*options, std::move(*world));
  impl->site = make_site(*options, impl->world.layout().size_m);
  impl->devices = make_devices(*options);
  impl->start_ns = options->start_stamp_ns.value_or(kEpochNs + static_cast<StampNs>(options->seed % 1'000'000) *
                                                                   from_seconds(1000));
  Random phases(options->seed, 30);
  for (std::size_t i = 0; i < impl->site.global_lidars.size(); ++i) {
    const double period_s = 1 / options->lidar_rate_hz;
    impl->streams.push_back({Source::lidar, i, phases.uniform(2 * kLidarJitter_s, period_s), period_s});
  }
  for (std::size_t i = 0; i < impl->devices.size(); ++i) {
    if (options->imu_rate_hz > 0) impl->streams.push_back({Source::imu, i, 0, 1 / options->imu_rate_hz});
    impl->streams.push_back({Source::device, i, kFirstDeviceFrame_s, 1 / impl->devices[i].rate_hz});
    impl->imu_errors.emplace_back(options->seed, 200 + i, options->imu_noise);
  }
  return Simulation(std::move(impl));
}

const SimOptions& Simulation::options() const {
  return impl_->options;
}
const Site& Simulation::site() const {
  return impl_->site;
}
const std::vector<DeviceInfo>& Simulation::devices() const {
  return impl_->devices;
}
StampNs Simulation::start_ns() const {
  return impl_->start_ns;
}

std::optional<SimEvent> Simulation::Impl::emit(const Stream& stream, double time_s) {
  const SimOptions& o = options;
  SimEvent event{start_ns + static_cast<StampNs>(std::llround(time_s * kNsPerSecond)), {}};
  const StampNs device_stamp_ns = event.at_ns + from_ms(o.device_clock_offset_ms);
  const std::uint64_t key =
      mix(mix(mix(o.seed) + stream.index + (stream.source == Source::lidar ? 0 : 1000)) + stream.count);
  if (stream.source == Source::lidar) {
    if (during(time_s, o.ceiling_gap_start_s, o.ceiling_gap_seconds)) return std::nullopt;
    const GlobalLidar& lidar = site.global_lidars[stream.index];
    event.payload = LidarFrame{stream.index, render(time_s, lidar.camera, lidar.T_map_sensor, o.lidar_range_m,
                                                    o.lidar_sensor, false, key, event.at_ns)};
  } else if (stream.source == Source::device) {
    const bool covered = stream.index == static_cast<std::size_t>(o.blocked_device) &&
                         during(time_s, o.blocked_start_s, o.blocked_seconds);
    const Pose T = world.devices()[stream.index].at(time_s).T_map_sensor;
    event.payload = DeviceFrame{stream.index,
                                render(time_s, devices[stream.index].camera, T, o.device_range_m,
                                       o.device_sensor, covered, key, device_stamp_ns),
                                T};
  } else {
    ImuSample sample = sim::exact_imu(world.devices()[stream.index], mounted_imu(), time_s);
    sample.stamp_ns = device_stamp_ns;
    event.payload = DeviceImu{stream.index, imu_errors[stream.index].spoil(sample, stream.period_s)};
  }
  return event;
}

std::optional<SimEvent> Simulation::next() {
  while (true) {
    const auto soonest = std::ranges::min_element(impl_->streams, {}, &Stream::next_s);
    if (soonest == impl_->streams.end() || soonest->next_s() >= impl_->options.seconds) return std::nullopt;
    auto event = impl_->emit(*soonest, soonest->next_s());
    ++soonest->count;
    if (event) return event;
  }
}

std::size_t Simulation::skip_images_before(StampNs at_ns) {
  const double before_s = to_seconds(at_ns - impl_->start_ns);
  std::size_t skipped = 0;
  for (Stream& stream : impl_->streams)
    for (; stream.source != Source::imu && stream.next_s() < before_s; ++stream.count) ++skipped;
  return skipped;
}

Result<Cloud> Simulation::reference_scan() const {
  return scan_reference(impl_->world.layout(), impl_->options.threads);
}

Pose Simulation::T_map_sensor(std::size_t device, double time_s) const {
  return impl_->world.devices().at(device).at(time_s).T_map_sensor;
}

ImuSample Simulation::exact_imu(std::size_t device, double time_s) const {
  return sim::exact_imu(impl_->world.devices().at(device), mounted_imu(), time_s);
}

}  // namespace liloc::sim
