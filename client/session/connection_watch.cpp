#include "client/session/connection_watch.hpp"

#include "common/base/log.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;

constexpr auto kMissed = 5s;           // discovery and a driver's start take less
constexpr auto kAgain = 10s;           // what is told once is told again after it; by hand
constexpr auto kServerAgain = 5s;      // a server that comes and goes is told so often
constexpr std::uint64_t kRefused = 3;  // in a row

const char* remedy(Reason reason) {
  switch (reason) {
    case Reason::no_gpc:
      return "run `liloc doctor` on the server: its LiDARs are silent, or their clock is not the device's";
    case Reason::not_found:
      return "show more of what the ceiling LiDARs see, and check the intrinsics";
    case Reason::superseded:
    case Reason::overloaded:
    case Reason::late:
    case Reason::rate_limit:
      return "the server has no time for so many requests: ask less often (interval_ms)";
    case Reason::protocol_version:
      return "install the same version on client and server";
    case Reason::identity:
      return "give each device an id of its own";
    case Reason::shutting_down:
      return "the server is being stopped: start it again";
    default:
      return "check the intrinsics, the depth scale and the range";
  }
}

long seconds(ConnectionWatch::Time::duration span) {
  return std::chrono::duration_cast<std::chrono::seconds>(span).count();
}

}  // namespace

ConnectionWatch::ConnectionWatch(Names names, Time now)
    : names_(std::move(names)), arrived_at_(now), connected_at_(now), told_server_at_(now - kServerAgain) {}

std::string ConnectionWatch::frames_problem(Time now) const {
  if (now - arrived_at_ < kMissed) return "";
  if (names_.frames_from.empty())
    return fmt::format("no depth frames for {} s: nothing calls push_depth or push_points",
                       seconds(now - arrived_at_));
  return fmt::format(
      "no depth frames for {} s on {} ({}): check the topic's name, and that its driver runs there",
      seconds(now - arrived_at_), names_.frames_from, names_.network);
}

std::string ConnectionWatch::answers_problem(const SessionStats& stats, bool connected, Time now) const {
  if (!connected && now - connected_at_ >= kMissed)
    return fmt::format(
        "no server is found ({}): start liloc-server there, or correct domain, interface and peers",
        names_.network);
  if (stats.refusals_in_row < kRefused) return "";
  return fmt::format("the server refuses every request, {} so far ({}, {}): {}", stats.refusals_in_row,
                     name_of(stats.newest_refusal), names_.network, remedy(stats.newest_refusal));
}

std::string ConnectionWatch::tell(Told& told, std::string problem, Time now) {
  told.problem = std::move(problem);
  if (told.problem.empty() || (told.once && now - told.at < kAgain)) return "";
  told.once = true;
  told.at = now;
  return told.problem;
}

bool ConnectionWatch::server_changed(bool connected, Time now) {
  if (connected == connected_ || now - told_server_at_ < kServerAgain) return false;
  connected_ = connected;
  told_server_at_ = now;
  return true;
}

void ConnectionWatch::look(const SessionStats& stats, bool connected, Time now) {
  std::unique_lock lock(mutex_);
  const std::uint64_t arrived =
      stats.frames + stats.frames_dropped + stats.frames_refused + stats.frames_skipped;
  if (arrived != arrived_) arrived_at_ = now;
  arrived_ = arrived;
  if (connected) connected_at_ = now;
  const bool changed = server_changed(connected, now);
  const std::string lines[] = {tell(frames_, frames_problem(now), now),
                               tell(answers_, answers_problem(stats, connected, now), now)};
  lock.unlock();
  if (changed && connected) log::info("{}: the server is there", names_.client_id);
  if (changed && !connected)
    log::warning("{}: the server is gone; the device goes on by itself", names_.client_id);
  for (const std::string& line : lines)
    if (!line.empty()) log::warning("{}: {}", names_.client_id, line);
}

std::string ConnectionWatch::no_frames() const {
  const std::scoped_lock lock(mutex_);
  return frames_.problem;
}

std::string ConnectionWatch::no_answers() const {
  const std::scoped_lock lock(mutex_);
  return answers_.problem;
}

}  // namespace liloc
