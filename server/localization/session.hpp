#pragma once
// What the server remembers of one client, and how it decides.
#include <array>
#include <deque>
#include <mutex>
#include <optional>

#include "server/localization/equality.hpp"
#include "server/localization/pose_filter.hpp"
#include "server/localization/tracks.hpp"

namespace liloc {

/// When an answer counts as verified. Scores are points of `Judgement::score`.
struct VerifyOptions {
  EqualityThresholds equality;
  TrackOptions tracks;
  int spots = 3;                      ///< the paper's number
  double lead_per_spot = 0.08;        ///< of the best track over the second, over the spots in memory
  double conclusive_margin = 0.45;    ///< of one spot alone: score over the runner-up's ...
  double conclusive_agree = 0.45;     ///< ... share of device points on seen surfaces ...
  double conclusive_overlap = 0.985;  ///< ... and of those judged, how many agree
  double verified_sd_rad = radians(2.0), verified_sd_m = 0.08;  ///< most, in any direction
  double locked_sd_rad = radians(1.0), locked_sd_m = 0.05;      ///< least, to hold a refinement near its start
  double prior_residual_sd_m = 0.05;                            ///< of a pair of it
  double step_sd_rad = radians(0.2),
         step_sd_m = 0.008;  ///< least growth between spots: calibration and clocks err too
  int research_every = 6;    ///< while tracking, every so many spots the whole room is searched
};

/// One client's session. `mutex` is held by whoever answers one of its requests.
class Session {
 public:
  explicit Session(const LocalizerOptions& options, VerifyOptions verify = {})
      : options_(options), verify_(verify) {}

  std::mutex mutex;

  /// Fills status, reason, pose and evidence of the reply.
  void answer(const SpotRequest& request, const std::shared_ptr<const Spot>& spot, SpotReply* reply);

 private:
  void answer_cold(const std::shared_ptr<const Spot>& spot, SpotReply* reply) const;
  void answer_searching(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  void answer_tracking(const SpotRequest& request, const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  void answer_as_paper(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  void start_segment(std::uint32_t segment);
  [[nodiscard]] bool conclusive(const std::vector<Hypothesis>& found) const;
  [[nodiscard]] bool sure(const PoseEstimate& estimate) const;
  struct Decision {
    Reason reason;
    Hypothesis here;
  };
  [[nodiscard]] std::optional<Decision> decide(const std::vector<Hypothesis>& found) const;
  std::optional<Decision> search_room(const std::shared_ptr<const Spot>& spot, std::vector<Hypothesis>* found);
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
  double last_margin_ = 0;
  int weak_in_a_row_ = 0, spots_since_search_ = 0;
};

}  // namespace liloc
