#pragma once
// What a client leaves behind for the evaluation: online.tum, trajectory.tum, spots.csv, local.csv and
// doubt.csv (the covariance of each pose of online.tum: row-major, sensor frame, [rad; m], separated by
// spaces), with the device's stamps. Rows are written as they happen, those of trajectory.tum ten seconds
// later, when no answer changes them any more.
#include <deque>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "client/engine/engine.hpp"
#include "common/base/row_file.hpp"

namespace liloc {

/// Not thread-safe. A write that fails is reported by the next call that returns a status; the files then hold
/// whole rows. Memory is bounded.
class TraceWriter {
 public:
  /// Makes the folder if need be and starts the files anew.
  [[nodiscard]] Status open(const std::filesystem::path& folder);
  /// In the order of the stamps, but where the device's clock was set back.
  [[nodiscard]] Status on_frame(const FrameResult& frame);
  /// A request left: if no reply is ever noted for it, it gets a row with the reason no_answer.
  void on_request(const SpotRequest& request);
  /// Its row with the reason no_answer now; a later reply gets no row.
  void on_timeout(std::uint64_t seq);
  /// Its row, and what it corrects. One that answers none of the requests, or one a second time, is ignored.
  void on_reply(const SpotReply& reply);
  /// Writes what is still open. trajectory.tum has each located frame with the corrections of the verified
  /// spots before and after it, mixed by their distance in time.
  [[nodiscard]] Status close();

 private:
  struct Located {
    StampNs stamp_ns;
    std::uint32_t segment;
    Pose T_odom_sensor, T_map_sensor;
  };
  struct Correction {
    StampNs stamp_ns;
    Pose T_map_odom;
  };
  void note(const Status& written);
  /// The rows of trajectory.tum up to a stamp.
  void write_trajectory(StampNs until_ns);
  void drop_corrections(StampNs before_ns);
  void write_spot(const SpotReply& reply);
  void write_doubt(const FrameResult& frame);
  [[nodiscard]] Pose corrected(const Located& frame) const;

  std::filesystem::path folder_;
  RowFile online_, spots_, local_, doubt_, trajectory_;
  Status status_;                             ///< the first error
  StampNs last_ns_ = 0;                       ///< of the newest frame
  std::map<std::uint64_t, StampNs> pending_;  ///< seq -> stamp of requests without a row
  std::set<std::uint64_t> timed_out_;
  std::deque<Located> frames_;                                    ///< not yet in trajectory.tum
  std::map<std::uint32_t, std::vector<Correction>> corrections_;  ///< by segment, by rising stamp
};

}  // namespace liloc
