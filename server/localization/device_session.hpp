#pragma once
// What the server remembers of one client, and how it decides.
#include <deque>
#include <mutex>
#include <optional>

#include "server/localization/following.hpp"
#include "server/localization/verification.hpp"

namespace liloc {

/// One client's session. `mutex` is held by whoever answers one of its requests.
class DeviceSession {
 public:
  explicit DeviceSession(const LocalizerOptions& options) : options_(options) { verify_.risk = options.risk; }

  std::mutex mutex;

  /// Fills status, reason, advice, pose, confidence and evidence of the reply.
  void answer(const SpotRequest& request, const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  /// What the newest search rested on; no places where the newest spot needed none.
  [[nodiscard]] const Evidence& evidence() const { return evidence_; }

 private:
  /// What belongs to one segment of the device's odometry.
  struct Segment {
    Segment(std::uint32_t of, const TrackOptions& options) : id(of), tracks(options) {}
    std::uint32_t id;
    Tracks tracks;
    std::deque<SpotPose> own_answers;  ///< the last three spots' own best poses
    std::optional<Followed> followed;  ///< once verified
    int weak_in_a_row = 0, spots_since_search = 0;
  };
  /// What a search of the room came to.
  struct Found {
    Hypothesis best;  ///< at this spot, of the best track
    PoseEstimate estimate;
    LookTerms looks;
    double log_odds = 0, margin = 0;
    bool stayed = false, own = false;  ///< refinement stays with it; this spot's own search came to it
  };

  void answer_cold(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  void answer_searching(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  void answer_following(const SpotRequest& request, const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  void answer_as_paper(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  std::optional<Found> search_room(const std::shared_ptr<const Spot>& spot, Tracks* tracks,
                                   const Hypothesis* followed = nullptr);
  Hypothesis follow(const SpotRequest& request, const Spot& spot);
  void search_beside(const std::shared_ptr<const Spot>& spot, const Hypothesis& here, SpotReply* reply);
  [[nodiscard]] bool due_for_search() const;
  void report_followed(const Hypothesis& here, SpotReply* reply) const;
  [[nodiscard]] bool enough(double confidence) const { return confidence >= least_confidence(verify_.risk); }

  const LocalizerOptions options_;
  VerifyOptions verify_;
  std::optional<Segment> segment_;
  Evidence evidence_;
};

}  // namespace liloc
