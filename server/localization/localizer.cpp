#include "server/localization/localizer.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <set>

#include "common/base/line_limit.hpp"
#include "common/base/log.hpp"
#include "server/localization/answered.hpp"

namespace liloc {

namespace {

using Clock = std::chrono::steady_clock;

// Sessions of clients that left hold their poses and last views, not the rooms that they looked at. By hand, as
// how long they may be of use: devices are carried on by odometry for about a minute before they count as lost.
constexpr std::size_t kMostParked = 16;
constexpr auto kParkedFor = std::chrono::seconds(60);

struct Parked {
  std::shared_ptr<DeviceSession> session;
  Clock::time_point since;
};

}  // namespace

struct Localizer::Impl {
  GlobalCloud& global_cloud;
  const LocalizerOptions options;
  const AnswerSink sink;
  std::shared_ptr<const CellBounds> learned;
  mutable std::mutex mutex;
  std::map<std::string, std::shared_ptr<DeviceSession>> sessions;
  std::map<std::string, Parked> parked;            ///< of clients that left, for those that come back
  std::map<std::string, Pose> last_learned;        ///< per client; a device that stands still teaches once
  std::set<std::string> troubled;                  ///< clients whose trouble the log has
  std::shared_ptr<const Snapshot> first_snapshot;  ///< static_noopt: the room as it was at the start
  SourceLimit failures{}, troubles{}, cut_offs{};  ///< lines of the log

  std::shared_ptr<DeviceSession> session(const std::string& client_id) {
    const std::scoped_lock lock(mutex);
    auto& held = sessions[client_id];
    if (!held) held = std::make_shared<DeviceSession>(options);
    return held;
  }

  /// The caller locks.
  [[nodiscard]] std::shared_ptr<DeviceSession> parked_session(const std::string& client_id) const {
    const auto found = parked.find(client_id);
    return found == parked.end() ? nullptr : found->second.session;
  }

  /// The session, if there is one, whose spots are to be forgotten without this lock.
  std::shared_ptr<DeviceSession> park(const std::string& client_id) {
    const std::scoped_lock lock(mutex);
    last_learned.erase(client_id);
    troubled.erase(client_id);
    const auto now = Clock::now();
    std::erase_if(parked, [&](const auto& entry) { return now - entry.second.since > kParkedFor; });
    const auto found = sessions.find(client_id);
    if (found == sessions.end()) return parked_session(client_id);  // left while a worker held it
    const auto left = found->second;
    parked[client_id] = {left, now};
    sessions.erase(found);
    if (parked.size() > kMostParked)
      parked.erase(std::ranges::min_element(parked, {}, [](const auto& entry) { return entry.second.since; }));
    return left;
  }

  Result<std::shared_ptr<const Snapshot>> snapshot(StampNs stamp_ns) {
    auto nearest = global_cloud.nearest(stamp_ns);
    if (!nearest || options.method != Method::static_noopt) return nearest;
    const std::scoped_lock lock(mutex);
    if (!first_snapshot) first_snapshot = *nearest;
    return first_snapshot;
  }

  SpotReply answer(const SpotRequest& request) {
    const auto held = session(request.client_id);
    const std::scoped_lock in_turn(held->mutex);
    const auto room = snapshot(request.match_stamp_ns());
    if (!room) return refusal(request, Reason::no_gpc, room.error().message);
    const auto known = bounds();
    const bool spare_time = !options.idle || options.idle();
    std::optional<Answered> kept;
    if (sink) kept = Answered{options, request, *room, known, held->segment(), {}, spare_time, {}};
    const auto spot = spot_of(*held, request, *room, options, known);
    SpotReply reply = spot ? answer_of(*held, *spot, spare_time).reply
                           : refusal(request, Reason::bad_cloud, spot.error().message);
    if (spot) note_trouble(request.client_id, **spot);
    if (spot) learn(**spot, reply);
    if (reply.reason == Reason::overloaded) note_cut_off(request.client_id);
    if (kept) {
      if (spot) kept->moving = (*spot)->moving();
      kept->reply = reply;
      sink(std::move(*kept));
    }
    return reply;
  }

  std::shared_ptr<const CellBounds> bounds() const {
    const std::scoped_lock lock(mutex);
    return learned;
  }

  /// Once for each client.
  void note_trouble(const std::string& client_id, const Spot& spot) {
    if (spot.trouble().empty()) return;
    const std::scoped_lock lock(mutex);
    if (troubled.contains(client_id)) return;
    const auto held = troubles.pass(client_id, std::chrono::steady_clock::now());
    if (!held) return;
    troubled.insert(client_id);
    log::warning("{}: {}{}", client_id, spot.trouble(), held_back(*held));
  }

  /// Who shows what takes long to search shows it again.
  void note_cut_off(const std::string& client_id) {
    const std::scoped_lock lock(mutex);
    if (const auto held = cut_offs.pass(client_id, std::chrono::steady_clock::now()))
      log::warning(
          "{}: a search was cut off after {:.1f} s and is not believed: what it did not reach may look alike{}",
          client_id, std::chrono::duration<double>(options.search_limit).count(), held_back(*held));
  }

  /// Who sends what cannot be handled sends it again.
  void note_failure(const SpotRequest& request, const char* why) {
    const std::scoped_lock lock(mutex);
    if (const auto held = failures.pass(request.client_id, std::chrono::steady_clock::now()))
      log::error("request {} of {}: {}{}", request.seq, request.client_id, why, held_back(*held));
  }

  void learn(const Spot& spot, const SpotReply& reply) {
    if (!reply.verified()) return;
    const std::scoped_lock lock(mutex);
    const auto [last, first] = last_learned.try_emplace(reply.client_id, *reply.T_map_sensor);
    if (!first && same_place(last->second, *reply.T_map_sensor)) return;
    last->second = *reply.T_map_sensor;
    auto more = std::make_shared<CellBounds>(*learned);
    more->learn(spot.middle_at(*reply.T_map_sensor), reply.fitness);
    learned = std::move(more);
  }
};

Localizer::Localizer(GlobalCloud& global_cloud, LocalizerOptions options, CellBounds learned, AnswerSink sink)
    : impl_(new Impl{global_cloud,
                     std::move(options),
                     std::move(sink),
                     std::make_shared<const CellBounds>(std::move(learned)),
                     {},
                     {},
                     {},
                     {},
                     {},
                     {},
                     {}}) {}

Localizer::~Localizer() = default;

SpotReply Localizer::locate(const SpotRequest& request) {
  const Stopwatch watch;
  SpotReply reply;
  try {
    reply = impl_->answer(request);
  } catch (
      const std::exception& trouble) {  // out of memory, a library's complaint: the client still gets an answer
    impl_->note_failure(request, trouble.what());
    reply = refusal(request, Reason::not_found, "the server failed on this request");
  }
  reply.server_id = impl_->options.server_id;
  reply.latency_ms = watch.elapsed_ms();
  return reply;
}

void Localizer::forget(const std::string& client_id) {
  const auto left = impl_->park(client_id);
  if (!left) return;
  // The network's thread must not wait for a search: who works on the session forgets again when he is done.
  const std::unique_lock in_turn(left->mutex, std::try_to_lock);
  if (in_turn) left->forget_spots();
}

std::optional<Remembered> Localizer::remembered(const std::string& client_id) const {
  std::unique_lock lock(impl_->mutex);
  const auto found = impl_->sessions.find(client_id);
  // A client that left while its request was in work has its session among those that are kept.
  const auto held = found != impl_->sessions.end() ? found->second : impl_->parked_session(client_id);
  lock.unlock();
  if (!held) return std::nullopt;
  const std::scoped_lock in_turn(held->mutex);
  return held->remembered();
}

void Localizer::resume(const std::string& client_id, const Remembered& remembered, double age_s) {
  // At least one: between the last spot and the next the odometry of one request is known.
  const double spots = 1 + age_s / to_seconds(kRequestInterval);
  const std::scoped_lock lock(impl_->mutex);
  std::shared_ptr<DeviceSession> session;
  if (const auto kept = impl_->parked.extract(client_id)) {
    session = kept.mapped().session;  // with what it saw of who moves
  } else {
    DeviceSession::Segment segment{remembered.odom_segment, Tracks(VerifyOptions{}.tracks)};
    segment.followed = remembered.followed;
    session = std::make_shared<DeviceSession>(impl_->options, std::move(segment));
  }
  // Where a worker still looks at it, it is not unwatched.
  if (const std::unique_lock in_turn(session->mutex, std::try_to_lock); in_turn) session->unwatched_for(spots);
  impl_->sessions[client_id] = std::move(session);
}

void Localizer::forget_all() {
  const std::scoped_lock lock(impl_->mutex);
  impl_->sessions.clear();
  impl_->parked.clear();
  impl_->last_learned.clear();
  impl_->troubled.clear();
}

std::shared_ptr<const CellBounds> Localizer::learned() const {
  return impl_->bounds();
}

}  // namespace liloc
