#include "proto-tests/soak/visitors.hpp"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <memory>
#include <mutex>
#include <thread>

#include "client/include/liloc/client.hpp"
#include "proto-tests/replay/processes.hpp"

namespace liloc::soak {
namespace {

constexpr double kMostBehind_s = 0.3;    // as of the stage
constexpr int kGivenBack_bytes = 65536;  // below an image or a room; by hand

client::Pose public_pose(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return {{pose.translation().x(), pose.translation().y(), pose.translation().z()},
          {q.x(), q.y(), q.z(), q.w()}};
}

client::Options options_of(const DeviceInfo& device, const std::string& id, const wire::DomainOptions& seat) {
  client::Options options;
  options.id = id;
  const Camera& c = device.camera;
  options.camera = {c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.depth_scale_m};
  options.domain = seat.domain;
  if (device.T_imu_sensor) options.T_imu_sensor = public_pose(*device.T_imu_sensor);
  return options;
}

/// One client while it is there. Fed by one thread, begun and ended by another.
class Guest {
 public:
  static Result<std::unique_ptr<Guest>> come(const client::Options& options, const RunClock& clock) {
    auto guest = std::make_unique<Guest>(clock);
    auto made = client::Client::create(options, {}, [raw = guest.get()](const client::Reply& reply) {
      if (reply.verified) raw->note_located();
    });
    if (!made) return fail("soak: {}", made.error());
    guest->client_ = std::move(made.value());
    return guest;
  }
  explicit Guest(const RunClock& clock) : clock_(clock) { visit_.from_s = clock.now_s(); }

  void feed(const TapePlayer::Moment& moment) {
    const StampNs stamp_ns = clock_.stamp_ns(moment.at_s);
    if (const auto* frame = std::get_if<sim::DeviceFrame>(&moment.event->payload)) {
      const DepthImage& image = frame->image;
      (void)client_->push_depth(image.units.data(), image.width, image.height, stamp_ns);
    } else if (const auto* imu = std::get_if<sim::DeviceImu>(&moment.event->payload)) {
      const ImuSample sample = moment.backwards ? reversed(imu->sample) : imu->sample;
      const Eigen::Vector3d &w = sample.angular_velocity_rad_s, &f = sample.specific_force_m_s2;
      (void)client_->push_imu(stamp_ns, {w.x(), w.y(), w.z()}, {f.x(), f.y(), f.z()});
    }
  }
  Visit leave() {
    (void)client_->stop();  // it writes no trace, so that nothing can fail
    const client::Stats stats = client_->stats();
    client_.reset();
    visit_.to_s = clock_.now_s();
    visit_.frames = stats.frames;
    visit_.requests = stats.requests;
    visit_.replies = stats.replies;
    visit_.verified = stats.replies_verified;
    visit_.located_after_s = located_after_s_;
    return visit_;
  }

 private:
  void note_located() {
    if (located_after_s_ < 0) located_after_s_ = clock_.now_s() - visit_.from_s;
  }

  const RunClock clock_;
  Visit visit_;
  std::atomic<double> located_after_s_ = -1;
  std::unique_ptr<client::Client> client_;  // last: its threads call the above
};

/// Who is there, by place.
class House {
 public:
  House(const Tape& tape, const SoakOptions& options, const RunClock& clock, const wire::DomainOptions& seat)
      : tape_(tape), options_(options), clock_(clock), seat_(seat), guests_(places()) {}

  /// Has one place's guests come and go until the run is over. Errors: of a client.
  Status keep(std::size_t place) {
    std::size_t number = 0;
    for (const Span& stay : draw_visits(options_, place)) {
      wait_until(stay.from_s);
      if (broken_ || replay::stop_requested()) break;
      const std::string id = fmt::format("visitor{}-{}", place, number++);
      auto guest = Guest::come(options_of(tape_.devices[way_of(place)], id, seat_), clock_);
      if (!guest) broken_ = true;
      if (!guest) return tl::unexpected(guest.error());
      swap(place, *guest);
      wait_until(stay.to_s);
      swap(place, *guest);
      const Visit visit = (*guest)->leave();
      const std::scoped_lock lock(mutex_);
      visits_.push_back(visit);
    }
    return {};
  }
  void feed(const TapePlayer::Moment& moment, std::size_t way) {
    const std::scoped_lock lock(mutex_);
    for (std::size_t place = way; place < places(); place += tape_.devices.size())
      if (guests_[place]) guests_[place]->feed(moment);
  }
  /// A place's guests come no more.
  [[nodiscard]] bool broken() const { return broken_; }
  [[nodiscard]] std::size_t places() const { return static_cast<std::size_t>(options_.visitors); }
  /// After all places were kept.
  [[nodiscard]] std::vector<Visit> take_visits() { return std::move(visits_); }

 private:
  void wait_until(double s) const {
    while (!broken_ && !replay::stop_requested() && clock_.now_s() < s)
      clock_.sleep_until(std::min(s, clock_.now_s() + 0.5));
  }
  [[nodiscard]] std::size_t way_of(std::size_t place) const { return place % tape_.devices.size(); }
  void swap(std::size_t place, std::unique_ptr<Guest>& guest) {
    const std::scoped_lock lock(mutex_);
    guests_[place].swap(guest);
  }

  const Tape& tape_;
  const SoakOptions& options_;
  const RunClock clock_;
  const wire::DomainOptions seat_;
  std::atomic<bool> broken_ = false;
  std::mutex mutex_;  // guards what follows
  std::vector<std::unique_ptr<Guest>> guests_;
  std::vector<Visit> visits_;
};

/// What clients log goes to a file while this lives.
class ClientLog {
 public:
  explicit ClientLog(const std::filesystem::path& file) : out_(std::make_shared<Out>()) {
    out_->file.open(file);
    client::set_log([out = out_](int level, const std::string& line) {
      constexpr int kDebug = 0;
      if (level == kDebug) return;
      const std::scoped_lock lock(out->mutex);
      out->file << line << std::endl;  // flushed, for who looks meanwhile
    });
  }
  ClientLog(const ClientLog&) = delete;
  ClientLog& operator=(const ClientLog&) = delete;
  ~ClientLog() { client::set_log({}); }

 private:
  struct Out {
    std::mutex mutex;
    std::ofstream file;
  };
  std::shared_ptr<Out> out_;
};

/// Frames and samples of the ways, each at its time, until the run is over or something broke.
void feed_all(House& house, const Tape& tape, const SoakOptions& options, const RunClock& clock) {
  TapePlayer player(tape);
  while (!house.broken() && !replay::stop_requested()) {
    const auto moment = player.next();
    if (moment.at_s > options.seconds) return;
    const auto* frame = std::get_if<sim::DeviceFrame>(&moment.event->payload);
    const auto* imu = std::get_if<sim::DeviceImu>(&moment.event->payload);
    if (frame == nullptr && imu == nullptr) continue;
    clock.sleep_until(moment.at_s);
    if (frame != nullptr && clock.now_s() > moment.at_s + kMostBehind_s) continue;
    house.feed(moment, frame != nullptr ? frame->device : imu->device);
  }
}

}  // namespace

Result<std::vector<Visit>> play_visitors(const Tape& tape, const SoakOptions& options, const RunClock& clock,
                                         const wire::DomainOptions& seat) {
  mallopt(M_ARENA_MAX, 2);  // as the server: with a heap a thread, 16 of them fill over many minutes
  // What is freed goes back at once: what a heap keeps looks like a leak for minutes.
  mallopt(M_MMAP_THRESHOLD, kGivenBack_bytes);
  mallopt(M_TRIM_THRESHOLD, kGivenBack_bytes);
  const ClientLog log(options.out / "visitors.log");
  House house(tape, options, clock, seat);
  std::vector<Status> kept(house.places());
  std::vector<std::jthread> keepers;
  for (std::size_t place = 0; place < house.places(); ++place)
    keepers.emplace_back([&, place] { kept[place] = house.keep(place); });
  feed_all(house, tape, options, clock);
  keepers.clear();
  for (const Status& status : kept)
    if (!status) return tl::unexpected(status.error());
  return house.take_visits();
}

}  // namespace liloc::soak
