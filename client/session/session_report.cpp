#include "client/session/session_report.hpp"

#include <algorithm>
#include <vector>

#include "common/base/quantile.hpp"

namespace liloc {
namespace {

constexpr std::size_t kLatencies = 512;           // newest frames that the statistics are over; by hand
constexpr int kRefused = 3;                       // frames in a row: that is no hiccup; by hand
constexpr auto kBlind = std::chrono::seconds(2);  // who is carried may be metres off by then; by hand
constexpr StampNs kLongestStep = from_ms(1000);   // between frames that carry the pose on; by hand

const char* name_of(Tracking tracking) {
  switch (tracking) {
    case Tracking::searching:
      return "searching";
    case Tracking::tracking:
      return "tracking";
    case Tracking::coasting:
      return "coasting: located by the device alone";
    case Tracking::lost:
      return "lost: the pose may be anywhere near";
  }
  return "unknown";
}

/// The figures in a problem change from frame to frame, the problem does not.
std::string without_figures(std::string problem) {
  std::erase_if(problem, [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
  return problem;
}

}  // namespace

void SessionReport::write(const Lines& lines) const {
  for (const auto& [level, text] : lines) log::write(level, fmt::format("{}: {}", client_id_, text));
}

SessionReport::Lines SessionReport::changes(Tracking tracking, const std::string& problem) const {
  Lines lines;
  if (!problem.empty() && without_figures(problem) != without_figures(stats_.problem))
    lines.emplace_back(log::Level::warning, problem);
  if (tracking != tracking_)
    lines.emplace_back(
        tracking == Tracking::coasting || tracking == Tracking::lost ? log::Level::warning : log::Level::info,
        name_of(tracking));
  return lines;
}

void SessionReport::frame(const FrameResult& frame, Tracking tracking, std::string problem) {
  std::unique_lock lock(mutex_);
  const Lines lines = changes(tracking, problem);
  seen_ = std::chrono::steady_clock::now();
  refused_ = 0;
  tracking_ = tracking;
  stats_.problem = std::move(problem);
  ++stats_.frames;
  stats_.frames_uninformative += frame.informative ? 0 : 1;
  latencies_ms_.push_back(frame.latency_ms);
  if (latencies_ms_.size() > kLatencies) latencies_ms_.pop_front();
  if (newest_ && frame.T_map_sensor)  // a pause is not counted in full
    stats_.localized_s += to_seconds(std::clamp<StampNs>(frame.stamp_ns - newest_->stamp_ns, 0, kLongestStep));
  newest_ = frame;
  lock.unlock();
  write(lines);
}

SessionReport::Lines SessionReport::limited(Counter what, const std::string& why) {
  auto limit = std::ranges::find(limits_, what, &std::pair<Counter, LineLimit>::first);
  if (limit == limits_.end()) limit = limits_.insert(limit, {what, {}});
  const auto held = limit->second.pass(std::chrono::steady_clock::now());
  if (!held) return {};
  return {{log::Level::warning, why + (*held > 0 ? fmt::format(" (and {} before)", *held) : "")}};
}

void SessionReport::frame_refused(const std::string& why) {
  std::unique_lock lock(mutex_);
  ++refused_;
  ++stats_.frames_refused;
  stats_.problem = why;
  const Lines lines = limited(&SessionStats::frames_refused, why);
  lock.unlock();
  write(lines);
}

void SessionReport::frame_skipped() {
  const std::scoped_lock lock(mutex_);
  ++stats_.frames_skipped;
  seen_ = std::chrono::steady_clock::now();
}

void SessionReport::samples_refused(Counter what, std::uint64_t count, const std::string& why) {
  std::unique_lock lock(mutex_);
  stats_.*what += count;
  const Lines lines = limited(what, why);
  lock.unlock();
  write(lines);
}

void SessionReport::trace_failed(const std::string& why) {
  std::unique_lock lock(mutex_);
  const bool first = std::exchange(trace_problem_, why).empty();
  lock.unlock();
  if (first) log::error("{}: {}", client_id_, why);
}

void SessionReport::ended() {
  const std::scoped_lock lock(mutex_);
  ended_ = true;
}

void SessionReport::reply(const SpotReply& reply) {
  const std::scoped_lock lock(mutex_);
  ++stats_.replies;
  stats_.replies_verified += reply.verified() ? 1 : 0;
  const bool refused = reply.status == SpotStatus::refused;
  stats_.replies_refused += refused ? 1 : 0;
  stats_.refusals_in_row = refused ? stats_.refusals_in_row + 1 : 0;
  if (refused) stats_.newest_refusal = reply.reason;
}

void SessionReport::reply_dropped(const std::string& why) {
  samples_refused(&SessionStats::replies_dropped, 1, "reply dropped: " + why);
}

void SessionReport::spent(double cpu_s) {
  const std::scoped_lock lock(mutex_);
  stats_.cpu_s += cpu_s;
}

void SessionReport::count(Counter what, std::uint64_t by) {
  const std::scoped_lock lock(mutex_);
  stats_.*what += by;
}

std::optional<FrameResult> SessionReport::newest() const {
  const std::scoped_lock lock(mutex_);
  return newest_;
}

bool SessionReport::blind(Time now) const {
  return newest_ && !ended_ && (refused_ >= kRefused || now - seen_ > kBlind);
}

Tracking SessionReport::tracking(Time now) const {
  const std::scoped_lock lock(mutex_);
  return tracking_ != Tracking::searching && blind(now) ? Tracking::lost : tracking_;
}

SessionStats SessionReport::stats(Time now) const {
  const std::scoped_lock lock(mutex_);
  SessionStats stats = stats_;
  if (blind(now) && refused_ == 0)
    stats.problem =
        fmt::format("no depth frames for {:.1f} s", std::chrono::duration<double>(now - seen_).count());
  if (stats.problem.empty()) stats.problem = trace_problem_;
  if (latencies_ms_.empty()) return stats;
  const std::vector<double> latencies(latencies_ms_.begin(), latencies_ms_.end());
  stats.frame_ms_median = median(latencies);
  stats.frame_ms_p99 = quantile(latencies, 0.99);
  return stats;
}

}  // namespace liloc
