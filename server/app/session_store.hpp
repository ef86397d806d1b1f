#pragma once
// What a server remembers of the devices that it follows, for a minute, so that one that was started anew, or a
// device that has joined anew, need not be searched: beside the site's state, and written each second.
#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "common/geometry/camera.hpp"
#include "server/localization/following.hpp"

namespace liloc {

/// "x/site.state.json" has "x/site.sessions.json" beside it; none for none.
[[nodiscard]] std::string sessions_file_of(const std::string& state_file);

/// By the run of a client, which draws its session by chance: another run, or another device of the same id,
/// gets nothing. Bounded. Thread-safe.
class SessionStore {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// What was remembered, and how long ago.
  struct Resumable {
    Remembered remembered;
    double age_s = 0;
  };

  /// Reads `file`, where there is one: what is over a minute old, of another site or cannot be used counts for
  /// nothing; the latter is told in the log. A client that cannot be used does not cost the others. `file`
  /// empty: in memory alone. `wall_ns`: the computer's time.
  SessionStore(std::string file, const Site& site, StampNs wall_ns, Time now);

  /// A run of a client asks for the first time: what is remembered of it.
  [[nodiscard]] std::optional<Resumable> begin(const std::string& client_id, std::uint64_t session, Time now);
  /// What is known of a client after an answer; ignored where another run of it has begun meanwhile.
  void note(const std::string& client_id, std::uint64_t session, const std::optional<Remembered>& remembered,
            Time now);
  /// Writes the file where something has changed, for its owner alone: who knows a session may take a device's
  /// place. Errors: it cannot be written; the next call tries again.
  [[nodiscard]] Status save(StampNs wall_ns, Time now);

 private:
  struct Known {
    std::uint64_t session = 0;
    Time at{};
    std::optional<Remembered> remembered;
  };
  void read(StampNs wall_ns, Time now);
  void make_room(Time now);

  const std::string file_, site_;  ///< site_: where its LiDARs hang
  std::mutex saving_;              ///< held while the file is written; before the other
  mutable std::mutex mutex_;
  std::map<std::string, Known> known_;  ///< by client
  bool changed_ = false;
};

}  // namespace liloc
