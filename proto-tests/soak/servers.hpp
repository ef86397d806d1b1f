#pragma once
// The servers of a run: one that stays, whose figures are judged, and a standby that is restarted.
#include <map>
#include <mutex>
#include <optional>

#include "common/wire/spots/status.hpp"
#include "proto-tests/replay/processes.hpp"
#include "proto-tests/soak/options.hpp"

namespace liloc::soak {

/// What the servers of a domain tell about themselves. Its thread hears until it goes.
class StatusWatch {
 public:
  /// Errors: DDS.
  [[nodiscard]] static Result<std::unique_ptr<StatusWatch>> start(const wire::DomainOptions& seat);
  /// The newest of a server; empty before its first.
  [[nodiscard]] std::optional<wire::ServerStatus> of(const std::string& server_id) const;

 private:
  explicit StatusWatch(wire::Participant participant) : participant_(std::move(participant)) {}
  wire::Participant participant_;
  mutable std::mutex mutex_;  // guards what follows
  std::map<std::string, wire::ServerStatus> newest_;
  std::unique_ptr<wire::Dispatcher> dispatcher_;  // last: its thread calls the above
};

/// A server that is ended again and again, asked and killed in turn, and started anew.
class Standby {
 public:
  Standby(const SoakOptions& options, std::vector<std::string> command, std::filesystem::path log_file);

  /// To be called often, from the start on. Errors: it could not be started, or ended by itself.
  [[nodiscard]] Status tend(double now_s, const StatusWatch& watch);
  [[nodiscard]] Status stop();
  [[nodiscard]] int restarts() const { return restarts_; }
  /// Of those that were ended, how many had answered nobody although they had had the time.
  [[nodiscard]] int silent() const { return silent_; }

 private:
  [[nodiscard]] Status end(double now_s, const StatusWatch& watch);

  const double restart_s_, last_restart_s_;
  const std::vector<std::string> command_;
  const std::filesystem::path log_file_;
  std::optional<replay::Child> child_;
  double started_s_ = 0, next_end_s_ = 0, next_start_s_ = 0;
  int restarts_ = 0, silent_ = 0;
};

}  // namespace liloc::soak
