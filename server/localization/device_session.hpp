#pragma once
// What the server remembers of one client, and how it decides.
#include <deque>
#include <mutex>
#include <optional>

#include "server/localization/earlier_views.hpp"
#include "server/localization/following.hpp"
#include "server/localization/verification.hpp"

namespace liloc {

/// One client's session. `mutex` is held by whoever answers one of its requests.
class DeviceSession {
 public:
  /// What belongs to one segment of the device's odometry.
  struct Segment {
    std::uint32_t id = 0;
    Tracks tracks = Tracks();
    std::deque<SpotPose> own_answers = {};  ///< the last three spots' own best poses
    std::optional<Followed> followed = {};  ///< once verified
    int weak_in_a_row = 0, spots_since_search = 0;
  };

  /// `segment`: what an earlier session remembered.
  explicit DeviceSession(const LocalizerOptions& options, std::optional<Segment> segment = std::nullopt)
      : options_(options), segment_(std::move(segment)) {
    verify_.risk = options.risk;
  }

  std::mutex mutex;
  EarlierViews earlier_views;  ///< of what was asked; `spot_of` looks at them, and adds to them

  /// Fills status, reason, advice, pose and confidence of the reply. `spare_time`: there is time for a search
  /// that nobody waits for. Returns what the search of the room rested on; no places where this spot needed
  /// none.
  Evidence answer(const std::shared_ptr<const Spot>& spot, bool spare_time, SpotReply* reply);
  /// A pose that is followed; none while it searches.
  [[nodiscard]] std::optional<Remembered> remembered() const;
  /// Forgets the clouds of earlier spots, which hold their rooms; a pose that is followed goes on.
  void forget_spots() {
    if (segment_) segment_->tracks.clear();
  }
  /// Nobody looked for as long as so many spots take: a pose that is followed is less sure.
  void unwatched_for(double spots);
  /// What it remembers; the next answer rests on it.
  [[nodiscard]] const std::optional<Segment>& segment() const { return segment_; }

 private:
  /// What a search of the room came to.
  struct Found {
    enum class Outcome { place, nothing_fits, cut_off } outcome = Outcome::nothing_fits;
    Evidence evidence;
    Hypothesis best;  ///< at this spot, of the best track; this and what follows only where there is a place
    PoseEstimate estimate;
    double margin = 0;
    bool stayed = false, own = false;  ///< refinement stays with it; this spot's own search came to it

    [[nodiscard]] explicit operator bool() const { return outcome == Outcome::place; }
    [[nodiscard]] const LookTerms& looks() const { return evidence.places.front().looks; }
  };

  Evidence answer_cold(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  Evidence answer_searching(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  Evidence answer_following(const std::shared_ptr<const Spot>& spot, bool spare_time, SpotReply* reply);
  void answer_as_paper(const std::shared_ptr<const Spot>& spot, SpotReply* reply);
  static void refuse(const Found& found, SpotReply* reply);
  Found search_room(const std::shared_ptr<const Spot>& spot, Tracks* tracks,
                    const Hypothesis* followed = nullptr);
  Hypothesis follow(const Spot& spot);
  Found search_beside(const std::shared_ptr<const Spot>& spot, const Hypothesis& here, SpotReply* reply);
  [[nodiscard]] bool due_for_search(bool spare_time) const;
  void report_followed(const Hypothesis& here, SpotReply* reply) const;
  [[nodiscard]] bool enough(double confidence) const { return confidence >= least_confidence(verify_.risk); }

  const LocalizerOptions options_;
  VerifyOptions verify_;
  std::optional<Segment> segment_;
};

}  // namespace liloc
