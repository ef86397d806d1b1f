#include "server/view/journal.hpp"

#include <algorithm>

namespace liloc::view {
namespace {

constexpr std::chrono::seconds kGone{60};  // by hand

/// The newest answer on top of what was known before.
std::shared_ptr<const DeviceState> after(const DeviceState* before, const SpotReply& reply,
                                         std::optional<std::uint64_t> scan_seq,
                                         std::chrono::steady_clock::time_point at) {
  auto state = before != nullptr ? std::make_shared<DeviceState>(*before) : std::make_shared<DeviceState>();
  state->last = reply;
  state->at = at;
  state->scan_seq = scan_seq;
  ++state->answers;
  if (reply.gpc_stamp_ns != 0) state->confidence = reply.confidence;
  if (!reply.T_map_sensor) return state;
  state->T_map_sensor = reply.T_map_sensor;
  state->covariance = reply.covariance;
  state->pose_verified = reply.verified();
  if (!reply.verified()) return state;
  auto& trail = state->trail_map;
  if (trail.size() >= kTrailKept) trail.erase(trail.begin());
  trail.push_back(reply.T_map_sensor->translation().cast<float>());
  return state;
}

}  // namespace

Journal::Entry& Journal::entry_of(const std::string& client_id, Time at) {
  if (entries_.size() >= kDevicesKept && !entries_.contains(client_id))
    entries_.erase(std::ranges::min_element(entries_, {}, [](const auto& e) { return e.second.at; }));
  Entry& entry = entries_[client_id];
  entry.at = at;
  return entry;
}

void Journal::bound_scans() {
  const auto has_scan = [](const auto& e) { return e.second.scan != nullptr; };
  if (static_cast<std::size_t>(std::ranges::count_if(entries_, has_scan)) <= kScansKept) return;
  auto oldest = entries_.end();
  for (auto it = entries_.begin(); it != entries_.end(); ++it)
    if (it->second.scan && (oldest == entries_.end() || it->second.at < oldest->second.at)) oldest = it;
  oldest->second.scan.reset();
}

void Journal::located(const SpotRequest& request, const SpotReply& reply) {
  std::shared_ptr<UnlocatedScan> scan;
  if (!reply.verified() && request.lpc.bytes.size() <= kScanBytes)
    scan = std::make_shared<UnlocatedScan>(UnlocatedScan{request.seq, request.lpc, reply.T_map_sensor});
  const std::scoped_lock lock(mutex_);
  Entry& entry = entry_of(request.client_id, std::chrono::steady_clock::now());
  if (reply.T_map_odom) entry.odometry = Odometry{reply.odom_segment, *reply.T_map_odom};
  if (scan && !scan->T_map_sensor && entry.odometry && entry.odometry->segment == request.odom_segment)
    scan->T_map_sensor = entry.odometry->T_map_odom * request.T_odom_sensor;
  entry.scan = std::move(scan);
  bound_scans();
}

void Journal::answered(const SpotReply& reply, Time at) {
  const std::scoped_lock lock(mutex_);
  chart_.add(at, reply.status, reply.latency_ms);
  Entry& entry = entry_of(reply.client_id, at);
  entry.state = after(entry.state.get(), reply, entry.scan ? std::optional(entry.scan->seq) : std::nullopt, at);
}

void Journal::forget(const std::string& client_id) {
  const std::scoped_lock lock(mutex_);
  entries_.erase(client_id);
}

void Journal::forget_all() {
  const std::scoped_lock lock(mutex_);
  entries_.clear();
}

std::vector<std::shared_ptr<const DeviceState>> Journal::devices(Time now) const {
  std::vector<std::shared_ptr<const DeviceState>> told;
  const std::scoped_lock lock(mutex_);
  for (const auto& [id, entry] : entries_)
    if (entry.state && now - entry.state->at < kGone) told.push_back(entry.state);
  return told;
}

std::shared_ptr<const UnlocatedScan> Journal::scan_of(const std::string& client_id) const {
  const std::scoped_lock lock(mutex_);
  const auto found = entries_.find(client_id);
  return found == entries_.end() ? nullptr : found->second.scan;
}

std::vector<ChartColumn> Journal::columns(Time now) const {
  const std::scoped_lock lock(mutex_);
  return chart_.columns(now);
}

}  // namespace liloc::view
