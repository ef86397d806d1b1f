#include "proto-tests/soak/stage.hpp"

#include <algorithm>
#include <memory>

#include "proto-tests/replay/processes.hpp"
#include "proto-tests/replay/streams.hpp"
#include "proto-tests/soak/schedule.hpp"

namespace liloc::soak {
namespace {

constexpr double kMostBehind_s = 0.3;  // of two frames at 6 Hz: what comes later than that is no live stream
constexpr double kAfter_s = 3;         // servers and clients are looked at once more

/// A seat in the domain with what it streams; gone as a whole.
struct Stand {
  wire::Participant participant;
  replay::Streams streams;
};

Result<std::unique_ptr<Stand>> stand(const wire::DomainOptions& seat, const Site& site,
                                     const std::vector<DeviceInfo>& devices) {
  auto participant = wire::Participant::create(seat);
  if (!participant) return tl::unexpected(participant.error());
  auto streams = replay::Streams::create(*participant, site, devices);
  if (!streams) return tl::unexpected(streams.error());
  return std::make_unique<Stand>(Stand{std::move(*participant), std::move(*streams)});
}

/// One that leaves the domain, and joins it again as a LiDAR that was without power does.
class FlappingLidar {
 public:
  FlappingLidar(const wire::DomainOptions& seat, const GlobalLidar& lidar, std::vector<Span> flaps)
      : seat_(seat), site_{"map", {lidar}}, flaps_(std::move(flaps)) {}

  Status publish(double at_s, DepthImage image) {
    while (next_ < flaps_.size() && at_s >= flaps_[next_].to_s) ++next_;
    if (next_ < flaps_.size() && flaps_[next_].holds(at_s)) {
      if (stand_) ++went_;
      stand_.reset();
      return {};
    }
    if (!stand_) {
      auto made = stand(seat_, site_, {});
      if (!made) return tl::unexpected(made.error());
      stand_ = std::move(*made);
    }
    return stand_->streams.ceiling(0, image);
  }
  [[nodiscard]] std::uint64_t went() const { return went_; }

 private:
  wire::DomainOptions seat_;
  Site site_;
  std::vector<Span> flaps_;
  std::size_t next_ = 0;
  std::unique_ptr<Stand> stand_;
  std::uint64_t went_ = 0;
};

class Stage {
 public:
  Stage(const Tape& tape, const SoakOptions& options, const RunClock& clock, std::unique_ptr<Stand> residents,
        const wire::DomainOptions& seat)
      : clock_(clock), ways_(tape.devices.size()), residents_(std::move(residents)) {
    for (std::size_t i = 0; i < tape.site.global_lidars.size(); ++i)
      lidars_.emplace_back(seat, tape.site.global_lidars[i], draw_flaps(options, i));
    count_ = static_cast<std::size_t>(options.residents);
  }

  Status send(const TapePlayer::Moment& moment) {
    const StampNs stamp_ns = clock_.stamp_ns(moment.at_s);
    if (const auto* ceiling = std::get_if<sim::LidarFrame>(&moment.event->payload)) {
      DepthImage image = ceiling->image;
      image.stamp_ns = stamp_ns;
      return lidars_[ceiling->lidar].publish(moment.at_s, std::move(image));
    }
    if (const auto* imu = std::get_if<sim::DeviceImu>(&moment.event->payload)) {
      ImuSample sample = moment.backwards ? reversed(imu->sample) : imu->sample;
      sample.stamp_ns = stamp_ns;
      return to_residents(imu->device, [&](std::size_t i) { return residents_->streams.imu(i, sample); });
    }
    const auto& frame = std::get<sim::DeviceFrame>(moment.event->payload);
    DepthImage image = frame.image;
    image.stamp_ns = stamp_ns;
    return to_residents(frame.device, [&](std::size_t i) { return residents_->streams.device(i, image); });
  }
  [[nodiscard]] std::uint64_t went() const {
    std::uint64_t sum = 0;
    for (const FlappingLidar& lidar : lidars_) sum += lidar.went();
    return sum;
  }

 private:
  Status to_residents(std::size_t way, const std::function<Status(std::size_t)>& give) const {
    for (std::size_t i = way; i < count_; i += ways_)
      if (const Status given = give(i); !given) return given;
    return {};
  }

  const RunClock clock_;
  std::size_t count_ = 0;
  const std::size_t ways_;
  std::unique_ptr<Stand> residents_;
  std::vector<FlappingLidar> lidars_;
};

}  // namespace

DeviceInfo resident_of(const Tape& tape, std::size_t number) {
  DeviceInfo info = tape.devices[number % tape.devices.size()];
  info.id = fmt::format("resident{}", number);
  info.still_seconds = 0;  // it is not there from the first second on
  return info;
}

Result<std::uint64_t> play_stage(const Tape& tape, const SoakOptions& options, const RunClock& clock,
                                 const wire::DomainOptions& seat) {
  std::vector<DeviceInfo> devices;
  for (int i = 0; i < options.residents; ++i) devices.push_back(resident_of(tape, static_cast<std::size_t>(i)));
  auto residents = stand(seat, {}, devices);
  if (!residents) return tl::unexpected(residents.error());
  Stage stage(tape, options, clock, std::move(*residents), seat);
  TapePlayer player(tape);
  while (!replay::stop_requested()) {
    const auto moment = player.next();
    if (moment.at_s > options.seconds + kAfter_s) break;
    clock.sleep_until(moment.at_s);
    const bool is_imu = std::holds_alternative<sim::DeviceImu>(moment.event->payload);
    if (!is_imu && clock.now_s() > moment.at_s + kMostBehind_s) continue;
    if (const Status sent = stage.send(moment); !sent) return tl::unexpected(sent.error());
  }
  return stage.went();
}

}  // namespace liloc::soak
