#include "client/engine/trace.hpp"

#include <algorithm>
#include <limits>

#include "common/geometry/pose_estimate.hpp"

namespace liloc {
namespace {

constexpr StampNs kFinalAfter = from_ms(10'000);  // answers come within seconds; by hand
constexpr std::size_t kMostTimedOut = 64;         // later answers to older requests are ignored; by hand
// What the files' columns are: proto-tests/replay reads them.
constexpr char kLocalHeader[] = "stamp_ns,informative,method,converged,latency_ms,tx,ty,tz,qx,qy,qz,qw";
constexpr char kSpotsHeader[] =
    "stamp_ns,gpc_stamp_ns,status,verified,reason,tx,ty,tz,qx,qy,qz,qw,fitness,inlier_rmse_m,overlap,margin,"
    "latency_ms,confidence,advice";
constexpr char kDoubtHeader[] = "stamp_ns,sd_rad,sd_m,covariance";
constexpr char kTumHeader[] = "# timestamp_s tx ty tz qx qy qz qw : T_map_sensor";

std::string numbers(const Pose& T, char separator) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  std::string text;
  for (const double v : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    if (!text.empty()) text += separator;
    text += fmt::format("{:.6f}", v);
  }
  return text;
}

/// Seconds with nine decimals, exactly: a double would round to a quarter of a microsecond.
std::string tum_row(StampNs stamp_ns, const Pose& T) {
  return fmt::format("{}.{:09d} {}", stamp_ns / 1'000'000'000, stamp_ns % 1'000'000'000, numbers(T, ' '));
}

}  // namespace

void TraceWriter::note(const Status& written) {
  if (status_ && !written) status_ = fail("the trace fails: {}", written.error().message);
}

Status TraceWriter::open(const std::filesystem::path& folder) {
  folder_ = folder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail("{}: {}: give --trace a folder that can be made", folder.string(), error.message());
  if (auto ok = online_.open(folder_ / "online.tum", kTumHeader); !ok) return ok;
  if (auto ok = trajectory_.open(folder_ / "trajectory.tum", kTumHeader); !ok) return ok;
  if (auto ok = spots_.open(folder_ / "spots.csv", kSpotsHeader); !ok) return ok;
  if (auto ok = doubt_.open(folder_ / "doubt.csv", kDoubtHeader); !ok) return ok;
  return local_.open(folder_ / "local.csv", kLocalHeader);
}

Status TraceWriter::on_frame(const FrameResult& frame) {
  if (frame.stamp_ns < last_ns_) {  // stamps of before say nothing any more
    write_trajectory(std::numeric_limits<StampNs>::max());
    corrections_.clear();
  }
  last_ns_ = frame.stamp_ns;
  note(local_.append(fmt::format("{},{:d},{},{:d},{:.3f},{}", frame.stamp_ns, frame.informative,
                                 name_of(frame.source), frame.converged, frame.latency_ms,
                                 numbers(frame.T_odom_sensor, ','))));
  if (frame.T_map_sensor) {
    note(online_.append(tum_row(frame.stamp_ns, *frame.T_map_sensor)));
    if (frame.covariance) write_doubt(frame);
    frames_.push_back({frame.stamp_ns, frame.odom_segment, frame.T_odom_sensor, *frame.T_map_sensor});
  }
  write_trajectory(frame.stamp_ns - kFinalAfter);
  return status_;
}

void TraceWriter::write_trajectory(StampNs until_ns) {
  for (; !frames_.empty() && frames_.front().stamp_ns <= until_ns; frames_.pop_front())
    note(trajectory_.append(tum_row(frames_.front().stamp_ns, corrected(frames_.front()))));
  if (!frames_.empty()) drop_corrections(frames_.front().stamp_ns);
}

/// All but the last one before: it is mixed with the next.
void TraceWriter::drop_corrections(StampNs before_ns) {
  for (auto segment = corrections_.begin(); segment != corrections_.end();) {
    auto& known = segment->second;
    while (known.size() > 1 && known[1].stamp_ns <= before_ns) known.erase(known.begin());
    const bool past = segment->first < frames_.front().segment && known.back().stamp_ns < before_ns;
    segment = past ? corrections_.erase(segment) : std::next(segment);
  }
}

void TraceWriter::write_doubt(const FrameResult& frame) {
  const PoseEstimate estimate{*frame.T_map_sensor, *frame.covariance};
  std::string row = fmt::format("{},{:.6f},{:.6f},", frame.stamp_ns, estimate.sd_rad(), estimate.sd_m());
  for (int i = 0; i < 36; ++i)
    row += fmt::format("{}{:.6g}", i > 0 ? " " : "", (*frame.covariance)(i / 6, i % 6));
  note(doubt_.append(row));
}

void TraceWriter::on_request(const SpotRequest& request) {
  pending_[request.seq] = request.stamp_ns;
}

void TraceWriter::on_timeout(std::uint64_t seq) {
  const auto it = pending_.find(seq);
  if (it == pending_.end()) return;
  SpotReply silence;
  silence.stamp_ns = it->second;
  silence.reason = Reason::no_answer;
  write_spot(silence);
  timed_out_.insert(seq);
  if (timed_out_.size() > kMostTimedOut) timed_out_.erase(timed_out_.begin());
  pending_.erase(it);
}

void TraceWriter::write_spot(const SpotReply& reply) {
  const bool answered = reply.reason != Reason::no_answer;
  std::string row = fmt::format("{},{},{},{:d},{},{}", reply.stamp_ns, reply.gpc_stamp_ns,
                                name_of(reply.status), reply.verified(), name_of(reply.reason),
                                reply.T_map_sensor ? numbers(*reply.T_map_sensor, ',') : ",,,,,,");
  if (answered)
    row += fmt::format(",{:.4f},{:.5f},{:.4f},{:.4f},{:.3f},{:.5f},{}", reply.fitness, reply.inlier_rmse_m,
                       reply.overlap, reply.margin, reply.latency_ms, reply.confidence, name_of(reply.advice));
  else
    row += ",,,,,,,";
  note(spots_.append(row));
}

void TraceWriter::on_reply(const SpotReply& reply) {
  const bool has_row = timed_out_.erase(reply.seq) > 0;
  if (!has_row && pending_.erase(reply.seq) == 0) return;
  if (!has_row) write_spot(reply);
  if (!reply.verified() || !reply.T_map_odom) return;
  auto& known = corrections_[reply.odom_segment];
  const auto after = std::upper_bound(known.begin(), known.end(), reply.stamp_ns,
                                      [](StampNs t, const Correction& c) { return t < c.stamp_ns; });
  known.insert(after, {reply.stamp_ns, *reply.T_map_odom});
}

Pose TraceWriter::corrected(const Located& frame) const {
  const auto found = corrections_.find(frame.segment);
  if (found == corrections_.end()) return frame.T_map_sensor;  // bridged by the guess, never verified
  const auto& known = found->second;
  const auto after = std::upper_bound(known.begin(), known.end(), frame.stamp_ns,
                                      [](StampNs t, const Correction& c) { return t < c.stamp_ns; });
  if (after == known.begin()) return known.front().T_map_odom * frame.T_odom_sensor;
  const Correction& before = *(after - 1);
  if (after == known.end()) return before.T_map_odom * frame.T_odom_sensor;
  const double share = static_cast<double>(frame.stamp_ns - before.stamp_ns) /
                       static_cast<double>(after->stamp_ns - before.stamp_ns);
  return interpolate(before.T_map_odom * frame.T_odom_sensor, after->T_map_odom * frame.T_odom_sensor, share);
}

Status TraceWriter::close() {
  while (!pending_.empty()) on_timeout(pending_.begin()->first);
  write_trajectory(std::numeric_limits<StampNs>::max());
  return status_;
}

}  // namespace liloc
