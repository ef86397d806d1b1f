#pragma once
#include "client/odometry/odometry.hpp"

namespace liloc {

/// What speaks for and against matches of one frame: the guess, and what the depth image shows of the map from
/// there. Refers to its arguments.
class MatchCheck {
 public:
  MatchCheck(const LocalMap& map, const DepthImage& image, const MotionGuess& guess,
             const OdometryOptions& options)
      : map_(map), image_(image), guess_(guess), options_(options) {}

  /// Whether the guess and the overlap speak for it.
  [[nodiscard]] bool believable(const ScanMatch& match) const;
  /// The same where there is no guess: the image must not look through what the map holds.
  [[nodiscard]] bool consistent(const ScanMatch& match) const;
  /// Whether most of what the map holds in view is seen: what peeps out beside somebody fits in many places.
  [[nodiscard]] bool unhidden(const ScanMatch& match) const;
  /// Whether a match that may be believed is better marked: it follows somebody who walks perhaps, or the place
  /// is one of several.
  [[nodiscard]] bool doubtful(const ScanMatch& match) const;
  /// By which matches compare: overlap, less what the view says against it.
  [[nodiscard]] double evidence(const ScanMatch& match) const;
  /// The same less what the guess says against it, for matches from a wide one.
  [[nodiscard]] double merit(const ScanMatch& match) const;

 private:
  [[nodiscard]] bool wide_prior() const;
  [[nodiscard]] LocalMap::View view(const ScanMatch& match) const;

  const LocalMap& map_;
  const DepthImage& image_;
  const MotionGuess& guess_;
  const OdometryOptions& options_;
};

}  // namespace liloc
