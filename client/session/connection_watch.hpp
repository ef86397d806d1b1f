#pragma once
#include <chrono>
#include <mutex>
#include <string>

#include "client/session/session_report.hpp"

namespace liloc {

/// Notices that nothing arrives: no frames, no server, nothing but refusals. Thread-safe; who hears a line may
/// ask.
class ConnectionWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Names {
    std::string client_id;
    std::string frames_from;  ///< a topic, for people; empty: calls of the program
    std::string network;      ///< domain and interface, for people
  };
  ConnectionWatch(Names names, Time now);

  /// To be called once or twice a second. Tells a server that comes or goes, and each problem at most every ten
  /// seconds.
  void look(const SessionStats& stats, bool connected, Time now);
  /// As of the last look, for people; empty: nothing was noticed. What comes first matters most.
  [[nodiscard]] std::string no_frames() const;
  [[nodiscard]] std::string no_answers() const;

 private:
  struct Told {
    std::string problem;
    Time at{};
    bool once = false;  ///< `at` is set
  };
  /// The line that is due, or none.
  [[nodiscard]] static std::string tell(Told& told, std::string problem, Time now);
  [[nodiscard]] std::string frames_problem(Time now) const;
  [[nodiscard]] std::string answers_problem(const SessionStats& stats, bool connected, Time now) const;
  [[nodiscard]] bool server_changed(bool connected, Time now);

  const Names names_;
  mutable std::mutex mutex_;
  Told frames_, answers_;
  std::uint64_t arrived_ = 0;  ///< frames, taken or not
  Time arrived_at_, connected_at_;
  bool connected_ = false;  ///< as it was told last
  Time told_server_at_;
};

}  // namespace liloc
