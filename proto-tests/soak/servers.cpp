#include "proto-tests/soak/servers.hpp"

#include <csignal>

namespace liloc::soak {
namespace {

constexpr double kDown_s = 2;  // a service manager takes half a second, a host longer
// Who is found every second, and asked every 800 ms, has answered by then.
constexpr double kAnswersWithin_s = 10;
constexpr auto kName = "liloc-standby";

}  // namespace

Result<std::unique_ptr<StatusWatch>> StatusWatch::start(const wire::DomainOptions& seat) {
  auto participant = wire::Participant::create(seat);
  if (!participant) return tl::unexpected(participant.error());
  std::unique_ptr<StatusWatch> watch(new StatusWatch(std::move(*participant)));
  auto dispatcher = wire::Dispatcher::create(watch->participant_);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  const Status heard =
      wire::subscribe_status(**dispatcher, [raw = watch.get()](const Result<wire::ServerStatus>& status) {
        if (status) raw->board_.note(*status);
      });
  if (!heard) return tl::unexpected(heard.error());
  watch->dispatcher_ = std::move(*dispatcher);
  watch->dispatcher_->start();
  return watch;
}

void StatusBoard::note(const wire::ServerStatus& status) {
  const std::scoped_lock lock(mutex_);
  newest_[status.server_id] = status;
}

std::optional<wire::ServerStatus> StatusBoard::of(const std::string& server_id) const {
  const std::scoped_lock lock(mutex_);
  const auto found = newest_.find(server_id);
  return found == newest_.end() ? std::nullopt : std::optional(found->second);
}

void StatusBoard::forget(const std::string& server_id) {
  const std::scoped_lock lock(mutex_);
  newest_.erase(server_id);
}

Standby::Standby(const SoakOptions& options, std::vector<std::string> command, std::filesystem::path log_folder)
    : restart_s_(options.restart_s),
      last_restart_s_(options.seconds - kDown_s - kAnswersWithin_s),
      command_(std::move(command)),
      log_folder_(std::move(log_folder)),
      next_end_s_(options.restart_s) {}

std::filesystem::path Standby::log_file() const {
  return log_folder_ / fmt::format("standby{}.log", restarts_ % 2);
}

Status Standby::tend(double now_s, StatusBoard& board) {
  if (!child_ && now_s < next_start_s_) return {};
  if (!child_)
    if (const Status started = start(now_s, board); !started) return started;
  if (!child_->running()) return tl::unexpected(child_->failure());
  const bool due = restart_s_ > 0 && now_s >= next_end_s_ && now_s < last_restart_s_;
  if (!due) return {};
  const Status ended = end(now_s, restarts_ % 2 == 1, board);
  ++restarts_;
  next_start_s_ = now_s + kDown_s;
  next_end_s_ = now_s + restart_s_;
  return ended;
}

Status Standby::start(double now_s, StatusBoard& board) {
  board.forget(kName);
  auto child = replay::Child::start(command_, log_file());
  if (!child) return tl::unexpected(child.error());
  child_.emplace(std::move(*child));
  started_s_ = now_s;
  return {};
}

Status Standby::end(double now_s, bool killed, const StatusBoard& board) {
  const auto told = board.of(kName);
  const bool had_time = now_s - started_s_ > kAnswersWithin_s, answered = told && told->answered > 0;
  if (killed) kill(child_->pid(), SIGKILL);
  const Status ended = child_->stop(kStopsWithin);
  child_.reset();
  if (had_time && !answered) {
    ++silent_;
    std::error_code ignored;
    std::filesystem::copy_file(log_file(), log_folder_ / "standby-silent.log",
                               std::filesystem::copy_options::overwrite_existing, ignored);
  }
  return killed ? Status{} : ended;
}

Status Standby::stop(double now_s, const StatusBoard& board) {
  return child_ ? end(now_s, false, board) : Status{};
}

}  // namespace liloc::soak
