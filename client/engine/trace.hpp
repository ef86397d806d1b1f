#pragma once
// What a client leaves behind for the evaluation: online.tum, trajectory.tum, spots.csv, local.csv and
// doubt.csv (the covariance of each pose of online.tum: row-major, sensor frame, [rad; m], separated by
// spaces), with the device's stamps. Rows are flushed as they happen; trajectory.tum is written at the end.
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <vector>

#include "client/engine/engine.hpp"

namespace liloc {

/// Not thread-safe. A write that fails is reported by the next call that returns a status.
class TraceWriter {
 public:
  /// Makes the folder if need be and starts the files anew.
  [[nodiscard]] Status open(const std::filesystem::path& folder);
  /// In the order of the stamps.
  [[nodiscard]] Status on_frame(const FrameResult& frame);
  /// A request left: if no reply is ever noted for it, it gets a row with the reason no_answer.
  void on_request(const SpotRequest& request);
  /// Its row with the reason no_answer now; a later reply gets no row.
  void on_timeout(std::uint64_t seq);
  /// Its row, and what it corrects. One that answers none of the requests, or one a second time, is ignored.
  void on_reply(const SpotReply& reply);
  /// Writes what is still open and trajectory.tum: each located frame with the corrections of the verified
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
  [[nodiscard]] Status start(std::ofstream& file, const char* name, const char* header);
  [[nodiscard]] Status healthy() const;
  void write_spot(const SpotReply& reply);
  void write_doubt(const FrameResult& frame);
  [[nodiscard]] Pose corrected(const Located& frame) const;

  std::filesystem::path folder_;
  std::ofstream online_, spots_, local_, doubt_;
  std::map<std::uint64_t, StampNs> pending_;  ///< seq -> stamp of requests without a row
  std::set<std::uint64_t> timed_out_;
  std::vector<Located> frames_;
  std::map<std::uint32_t, std::vector<Correction>> corrections_;  ///< by segment, by rising stamp
};

}  // namespace liloc
