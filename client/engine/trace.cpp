#include "client/engine/trace.hpp"

#include <algorithm>

#include "common/geometry/pose_estimate.hpp"

namespace liloc {
namespace {

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
  return fmt::format("{}.{:09d} {}\n", stamp_ns / 1'000'000'000, stamp_ns % 1'000'000'000, numbers(T, ' '));
}

}  // namespace

Status TraceWriter::start(std::ofstream& file, const char* name, const char* header) {
  file.open(folder_ / name, std::ios::trunc);
  file << header << std::endl;
  if (!file)
    return fail("{}: cannot be written: check the folder's permissions and space", (folder_ / name).string());
  return {};
}

Status TraceWriter::open(const std::filesystem::path& folder) {
  folder_ = folder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail("{}: {}: give --trace a folder that can be made", folder.string(), error.message());
  if (auto ok = start(online_, "online.tum", kTumHeader); !ok) return ok;
  if (auto ok = start(spots_, "spots.csv", kSpotsHeader); !ok) return ok;
  if (auto ok = start(doubt_, "doubt.csv", kDoubtHeader); !ok) return ok;
  return start(local_, "local.csv", kLocalHeader);
}

Status TraceWriter::healthy() const {
  if (online_ && spots_ && local_ && doubt_) return {};
  return fail("{}: writing the trace failed: is the disk full?", folder_.string());
}

Status TraceWriter::on_frame(const FrameResult& frame) {
  local_ << fmt::format("{},{:d},{},{:d},{:.3f},{}", frame.stamp_ns, frame.informative, frame.method,
                        frame.converged, frame.latency_ms, numbers(frame.T_odom_sensor, ','))
         << std::endl;
  if (frame.T_map_sensor) {
    online_ << tum_row(frame.stamp_ns, *frame.T_map_sensor) << std::flush;
    if (frame.covariance) write_doubt(frame);
    frames_.push_back({frame.stamp_ns, frame.odom_segment, frame.T_odom_sensor, *frame.T_map_sensor});
  }
  return healthy();
}

void TraceWriter::write_doubt(const FrameResult& frame) {
  const PoseEstimate estimate{*frame.T_map_sensor, *frame.covariance};
  doubt_ << fmt::format("{},{:.6f},{:.6f},", frame.stamp_ns, estimate.sd_rad(), estimate.sd_m());
  for (int i = 0; i < 36; ++i)
    doubt_ << fmt::format("{}{:.6g}", i > 0 ? " " : "", (*frame.covariance)(i / 6, i % 6));
  doubt_ << std::endl;
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
  pending_.erase(it);
}

void TraceWriter::write_spot(const SpotReply& reply) {
  const bool answered = reply.reason != Reason::no_answer;
  spots_ << fmt::format("{},{},{},{:d},{},{}", reply.stamp_ns, reply.gpc_stamp_ns, name_of(reply.status),
                        reply.verified(), name_of(reply.reason),
                        reply.T_map_sensor ? numbers(*reply.T_map_sensor, ',') : ",,,,,,");
  if (answered)
    spots_ << fmt::format(",{:.4f},{:.5f},{:.4f},{:.4f},{:.3f},{:.5f},{}", reply.fitness, reply.inlier_rmse_m,
                          reply.overlap, reply.margin, reply.latency_ms, reply.confidence,
                          name_of(reply.advice));
  else
    spots_ << ",,,,,,,";
  spots_ << std::endl;
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
  std::ofstream trajectory;
  if (auto ok = start(trajectory, "trajectory.tum", kTumHeader); !ok) return ok;
  for (const Located& frame : frames_) trajectory << tum_row(frame.stamp_ns, corrected(frame));
  trajectory.flush();
  if (!trajectory) return fail("{}: trajectory.tum could not be written: is the disk full?", folder_.string());
  return healthy();
}

}  // namespace liloc
