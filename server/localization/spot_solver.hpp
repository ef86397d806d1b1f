#pragma once
// The registration side of an answer: a request's cloud against a snapshot.
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "common/protocol/spot.hpp"
#include "common/registration/spot/spot.hpp"
#include "server/global_cloud/snapshot.hpp"
#include "server/localization/localizer.hpp"

namespace liloc {

/// Which of a request's points (sensor frame), by index, are seen but no part of the room.
using MovingPoints = std::function<std::vector<std::uint32_t>(const Cloud& cloud_sensor)>;

/// A spot to be solved: owns what its problem refers to, so that later spots can look back at it.
class Spot {
 public:
  /// `bounds`: what is known of right registrations, if anything is. `moving` empty: all belongs to the room.
  /// Error: the LPC cannot be decoded or has
  /// too few points.
  static Result<std::shared_ptr<const Spot>> create(const SpotRequest& request,
                                                    std::shared_ptr<const Snapshot> snapshot,
                                                    const LocalizerOptions& options,
                                                    std::shared_ptr<const CellBounds> bounds = nullptr,
                                                    const MovingPoints& moving = {});

  [[nodiscard]] const SpotProblem& problem() const { return *problem_; }
  /// What it was made of.
  [[nodiscard]] const SpotRequest& request() const { return request_; }
  [[nodiscard]] const std::shared_ptr<const Snapshot>& snapshot() const { return snapshot_; }
  [[nodiscard]] const Query& query() const { return query_; }
  /// What `moving` said.
  [[nodiscard]] const std::vector<std::uint32_t>& moving() const { return moving_; }
  [[nodiscard]] StampNs gpc_stamp_ns() const { return gpc_stamp_ns_; }
  [[nodiscard]] const Pose& T_odom_sensor() const { return request_.T_odom_sensor; }
  /// What of the request could not be used, for people; empty: nothing.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  /// The middle of the device's cloud if the device were there, map frame.
  [[nodiscard]] Eigen::Vector3d middle_at(const Pose& T_map_sensor) const {
    return T_map_sensor * middle_sensor_;
  }
  /// Whether right registrations at that place had such a fitness, as far as is known.
  [[nodiscard]] bool plausible(const Hypothesis& hypothesis) const;

 private:
  SpotRequest request_;
  std::vector<std::uint32_t> moving_;
  std::shared_ptr<const CellBounds> bounds_;
  std::string trouble_;
  std::shared_ptr<const Snapshot> snapshot_;
  StampNs gpc_stamp_ns_ = 0;
  Query query_;
  Eigen::Vector3d middle_sensor_ = Eigen::Vector3d::Zero();
  mutable std::once_flag described_once_;
  mutable Described described_;
  std::optional<SpotProblem> problem_;
};

/// What a search of the whole room came to.
struct RoomSearch {
  std::vector<Hypothesis> found;  ///< distinct, best first; may be empty
  bool cut_off = false;  ///< by the time limit: nothing is believed, what was not reached may look alike
};

/// By the method of the options. `liloc`: everything is tried that the problem allows, cheapest first; features
/// only when gravity alone is not convincing. The others: the paper's (grid-)RANSAC with ICP, best fitness
/// first.
[[nodiscard]] RoomSearch search(const Spot& spot, const LocalizerOptions& options);

/// Share by which the best score is above the second's, 0..1; 1 when it is alone.
[[nodiscard]] double margin_of(const std::vector<Hypothesis>& hypotheses);

}  // namespace liloc
