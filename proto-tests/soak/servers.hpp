#pragma once
// The servers of a run: one that stays, whose figures are judged, and a standby that is restarted.
#include <chrono>
#include <map>
#include <mutex>
#include <optional>

#include "common/wire/spots/status.hpp"
#include "proto-tests/replay/processes.hpp"
#include "proto-tests/soak/options.hpp"

namespace liloc::soak {

/// Whoever is asked to stop is killed after so long, and the run has failed. At a load of 11 on two cores a
/// server took over 5 s to finish what it had begun.
constexpr auto kStopsWithin = std::chrono::seconds(20);

/// What servers told about themselves last. Any thread may use it.
class StatusBoard {
 public:
  void note(const wire::ServerStatus& status);
  /// The newest of a server; empty before its first.
  [[nodiscard]] std::optional<wire::ServerStatus> of(const std::string& server_id) const;
  /// What one of that name told before says nothing about the next.
  void forget(const std::string& server_id);

 private:
  mutable std::mutex mutex_;  // guards what follows
  std::map<std::string, wire::ServerStatus> newest_;
};

/// Notes what the servers of a domain tell. Its thread hears until it goes.
class StatusWatch {
 public:
  /// Errors: DDS.
  [[nodiscard]] static Result<std::unique_ptr<StatusWatch>> start(const wire::DomainOptions& seat);
  [[nodiscard]] StatusBoard& board() { return board_; }

 private:
  explicit StatusWatch(wire::Participant participant) : participant_(std::move(participant)) {}
  wire::Participant participant_;
  StatusBoard board_;
  std::unique_ptr<wire::Dispatcher> dispatcher_;  // last: its thread calls the above
};

/// A server that is ended again and again, asked and killed in turn, and started anew.
class Standby {
 public:
  /// Logs to standby0.log and standby1.log of `log_folder` in turn, so that the one before can still be read;
  /// that of one that was silent is kept as standby-silent.log.
  Standby(const SoakOptions& options, std::vector<std::string> command, std::filesystem::path log_folder);

  /// To be called often, from the start on. Errors: it could not be started, or ended by itself.
  [[nodiscard]] Status tend(double now_s, StatusBoard& board);
  /// Ends the last one, which is judged, too.
  [[nodiscard]] Status stop(double now_s, const StatusBoard& board);
  [[nodiscard]] int restarts() const { return restarts_; }
  /// How many had answered nobody when they were ended, although they had had the time.
  [[nodiscard]] int silent() const { return silent_; }

 private:
  [[nodiscard]] Status start(double now_s, StatusBoard& board);
  [[nodiscard]] Status end(double now_s, bool killed, const StatusBoard& board);
  [[nodiscard]] std::filesystem::path log_file() const;

  const double restart_s_, last_restart_s_;
  const std::vector<std::string> command_;
  const std::filesystem::path log_folder_;
  std::optional<replay::Child> child_;
  double started_s_ = 0, next_end_s_ = 0, next_start_s_ = 0;
  int restarts_ = 0, silent_ = 0;
};

}  // namespace liloc::soak
