#include "client/src/session_report.hpp"

#include <algorithm>
#include <vector>

#include "common/base/log.hpp"
#include "common/base/quantile.hpp"

namespace liloc {
namespace {

constexpr std::size_t kLatencies = 512;
constexpr StampNs kLongestStep = from_ms(1000);  // between frames that carry the pose on

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

void SessionReport::log_changes(Tracking tracking, const std::string& problem) const {
  if (!problem.empty() && without_figures(problem) != without_figures(stats_.problem))
    log::warning("{}: {}", client_id_, problem);
  if (tracking != tracking_)
    log::write(
        tracking == Tracking::coasting || tracking == Tracking::lost ? log::Level::warning : log::Level::info,
        fmt::format("{}: {}", client_id_, name_of(tracking)));
}

void SessionReport::frame(const FrameResult& frame, Tracking tracking, std::string problem) {
  const std::scoped_lock lock(mutex_);
  log_changes(tracking, problem);
  tracking_ = tracking;
  stats_.problem = std::move(problem);
  ++stats_.frames;
  stats_.frames_uninformative += frame.informative ? 0 : 1;
  latencies_ms_.push_back(frame.latency_ms);
  if (latencies_ms_.size() > kLatencies) latencies_ms_.pop_front();
  if (newest_ && frame.T_map_sensor)  // a pause is not counted in full
    stats_.localized_s += to_seconds(std::min(frame.stamp_ns - newest_->stamp_ns, kLongestStep));
  newest_ = frame;
}

void SessionReport::reply(const SpotReply& reply) {
  const std::scoped_lock lock(mutex_);
  ++stats_.replies;
  stats_.replies_verified += reply.verified() ? 1 : 0;
  stats_.replies_refused += reply.status == SpotStatus::refused ? 1 : 0;
}

void SessionReport::spent(double cpu_s) {
  const std::scoped_lock lock(mutex_);
  stats_.cpu_s += cpu_s;
}

void SessionReport::count(std::uint64_t SessionStats::*what, std::uint64_t by) {
  const std::scoped_lock lock(mutex_);
  stats_.*what += by;
}

std::optional<FrameResult> SessionReport::newest() const {
  const std::scoped_lock lock(mutex_);
  return newest_;
}

Tracking SessionReport::tracking() const {
  const std::scoped_lock lock(mutex_);
  return tracking_;
}

SessionStats SessionReport::stats() const {
  const std::scoped_lock lock(mutex_);
  SessionStats stats = stats_;
  if (latencies_ms_.empty()) return stats;
  const std::vector<double> latencies(latencies_ms_.begin(), latencies_ms_.end());
  stats.frame_ms_median = median(latencies);
  stats.frame_ms_p99 = quantile(latencies, 0.99);
  return stats;
}

}  // namespace liloc
