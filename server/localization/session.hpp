#pragma once
// What the server remembers of one client, and how it decides.
#include <array>
#include <deque>
#include <mutex>
#include <optional>

#include "server/localization/verification.hpp"

namespace liloc {

/// One client's session. `mutex` is held by whoever answers one of its requests.
class Session {
 public:
  explicit Session(const LocalizerOptions& options, VerifyOptions verify = {})
      : options_(options), verify_(verify) {}

  std::mutex mutex;

  /// Fills status, reason, pose and evidence of the reply.
  void answer(const SpotRequest& request, const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  /// What the newest answer rested on.
  [[nodiscard]] const Evidence& evidence() const { return evidence_; }

 private:
  void answer_cold(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  void answer_searching(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  void answer_tracking(const SpotRequest& request, const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  void answer_as_paper(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  void start_segment(std::uint32_t segment);
  std::optional<Reason> search_room(const std::shared_ptr<const Spot>& spot,
                                    const std::optional<Hypothesis>& followed = std::nullopt);
  [[nodiscard]] Evidence gathered(const Spot& spot, const std::vector<Hypothesis>& found) const;
  bool follow(const SpotRequest& request, const Spot& spot, SpotReply* reply);

  const LocalizerOptions options_;
  const VerifyOptions verify_;
  std::uint32_t segment_ = 0;
  bool started_ = false;
  Tracks tracks_{verify_.tracks};
  std::deque<SpotPose> own_answers_;       ///< the last three spots' own best poses
  std::optional<PoseEstimate> estimate_;   ///< at the newest spot, once verified
  Pose T_odom_sensor_ = Pose::Identity();  ///< of that spot
  bool followed_ = false;                  ///< the newest spot bore the track out
  bool doubted_ = false;  ///< lines of sight contradict the track, or it has been weak for long
  double last_margin_ = 0;
  Evidence evidence_;
  int weak_in_a_row_ = 0, spots_since_search_ = 0;
};

}  // namespace liloc
