#include "server/view/log_tail.hpp"

namespace liloc::view {
namespace {

constexpr std::size_t kLines = 100, kBytes = 300;  // by hand: all of it is sent when a line is added

}  // namespace

void LogTail::add(log::Level level, std::string_view text) {
  LogLine line{std::chrono::system_clock::now(), level, std::string(text.substr(0, kBytes))};
  if (text.size() > kBytes) line.text.replace(kBytes - 3, 3, "...");
  const std::scoped_lock lock(mutex_);
  lines_.push_back(std::move(line));
  if (lines_.size() > kLines) lines_.pop_front();
  ++count_;
}

std::vector<LogLine> LogTail::lines() const {
  const std::scoped_lock lock(mutex_);
  return {lines_.begin(), lines_.end()};
}

std::uint64_t LogTail::count() const {
  const std::scoped_lock lock(mutex_);
  return count_;
}

}  // namespace liloc::view
