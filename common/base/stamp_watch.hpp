#pragma once
#include <deque>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "common/base/stamp.hpp"

namespace liloc {

struct StampRules {
  std::string what;        ///< of the stream, for people: "depth"
  StampNs closest_ns = 0;  ///< stamps that rise by less on average are in another unit ...
  std::size_t judged = 3;  ///< ... over so many
};

/// Judges the stamps of one stream. A lone one that is far off is left out; several in a row say that the clock
/// was set. Not thread-safe.
class StampWatch {
 public:
  explicit StampWatch(StampRules rules) : rules_(std::move(rules)) {}

  /// By how much the clock was set, as of this stamp: 0 where it was not, negative where it was set back; a
  /// pause of the stream cannot be told from a clock set ahead. Errors: not positive, another unit than
  /// nanoseconds, not newer than the last, far off and not (yet) confirmed by others; the sample is to be
  /// dropped.
  [[nodiscard]] Result<StampNs> add(StampNs stamp_ns);

 private:
  [[nodiscard]] Status check_unit(StampNs stamp_ns);
  [[nodiscard]] Result<StampNs> add_stray(StampNs stamp_ns);

  StampRules rules_;
  std::optional<StampNs> last_ns_;  ///< taken
  std::deque<StampNs> seen_;        ///< the newest, taken or not
  int strays_ = 0;                  ///< far off on one side, in a row and rising
  StampNs first_stray_ns_ = 0, last_stray_ns_ = 0;
};

/// The error names the unit that a stamp looks like: as the seconds, milliseconds or microseconds of `wall_ns`,
/// within an hour. A clock that counts from another moment passes such an hour in under four seconds.
[[nodiscard]] Status check_unit_by(StampNs wall_ns, StampNs stamp_ns, const std::string& what);

}  // namespace liloc
