#include "proto-tests/soak/servers.hpp"

#include <csignal>

namespace liloc::soak {
namespace {

constexpr double kDown_s = 2;  // a service manager takes half a second, a host longer
constexpr double kAnswersWithin_s =
    10;  // who is found every second, and asked every 800 ms, has answered by then

}  // namespace

Result<std::unique_ptr<StatusWatch>> StatusWatch::start(const wire::DomainOptions& seat) {
  auto participant = wire::Participant::create(seat);
  if (!participant) return tl::unexpected(participant.error());
  std::unique_ptr<StatusWatch> watch(new StatusWatch(std::move(*participant)));
  auto dispatcher = wire::Dispatcher::create(watch->participant_);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  const Status heard =
      wire::subscribe_status(**dispatcher, [raw = watch.get()](const Result<wire::ServerStatus>& status) {
        if (!status) return;
        const std::scoped_lock lock(raw->mutex_);
        raw->newest_[status->server_id] = *status;
      });
  if (!heard) return tl::unexpected(heard.error());
  watch->dispatcher_ = std::move(*dispatcher);
  watch->dispatcher_->start();
  return watch;
}

std::optional<wire::ServerStatus> StatusWatch::of(const std::string& server_id) const {
  const std::scoped_lock lock(mutex_);
  const auto found = newest_.find(server_id);
  return found == newest_.end() ? std::nullopt : std::optional(found->second);
}

Standby::Standby(const SoakOptions& options, std::vector<std::string> command, std::filesystem::path log_file)
    : restart_s_(options.restart_s),
      last_restart_s_(options.seconds - kDown_s - kAnswersWithin_s),
      command_(std::move(command)),
      log_file_(std::move(log_file)),
      next_end_s_(options.restart_s) {}

Status Standby::tend(double now_s, const StatusWatch& watch) {
  if (!child_ && now_s >= next_start_s_) {
    auto child = replay::Child::start(command_, log_file_);
    if (!child) return tl::unexpected(child.error());
    child_.emplace(std::move(*child));
    started_s_ = now_s;
  }
  if (!child_) return {};
  if (!child_->running()) return tl::unexpected(child_->failure());
  const bool due = restart_s_ > 0 && now_s >= next_end_s_ && now_s < last_restart_s_;
  return due ? end(now_s, watch) : Status{};
}

Status Standby::end(double now_s, const StatusWatch& watch) {
  const auto told = watch.of("liloc-standby");
  const bool had_time = now_s - started_s_ > kAnswersWithin_s;
  // What an earlier one told is older than this one is.
  const bool answered = told && told->answered > 0 && told->uptime_s < now_s - started_s_ + 1;
  if (had_time && !answered) ++silent_;
  const bool killed = restarts_++ % 2 == 1;
  if (killed) kill(child_->pid(), SIGKILL);
  const Status ended = child_->stop();
  child_.reset();
  next_start_s_ = now_s + kDown_s;
  next_end_s_ = now_s + restart_s_;
  return killed ? Status{} : ended;
}

Status Standby::stop() {
  return child_ ? child_->stop() : Status{};
}

}  // namespace liloc::soak
