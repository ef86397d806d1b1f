#include "common/base/log.hpp"

#include <condition_variable>
#include <memory>
#include <mutex>

#include "common/base/log_level.hpp"
#include "common/base/text.hpp"

namespace liloc::log {
namespace {

struct Listener {
  Sink sink;
  int calls = 0;  ///< in flight
};

std::mutex mutex;  ///< guards what follows, and the counts of calls
std::condition_variable returned;
std::shared_ptr<Listener> current;
thread_local int calls_deep = 0;

/// While it lives the listener is in a call of this thread.
class Call {
 public:
  explicit Call(Listener& listener) : listener_(listener) { ++calls_deep; }
  ~Call() {
    --calls_deep;
    const std::scoped_lock lock(mutex);
    --listener_.calls;
    returned.notify_all();
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  Listener& listener_;
};

}  // namespace

const char* name_of(Level level) {
  switch (level) {
    case Level::debug:
      return "debug";
    case Level::info:
      return "info";
    case Level::warning:
      return "warning";
    case Level::error:
      return "error";
  }
  return "info";
}

Result<Level> level_from(std::string_view name) {
  for (const Level level : {Level::debug, Level::info, Level::warning, Level::error})
    if (name == name_of(level)) return level;
  return fail("log level is '{}'; must be debug, info, warning or error", name);
}

void set_sink(Sink sink) {
  auto next = sink ? std::make_shared<Listener>(Listener{std::move(sink)}) : nullptr;
  std::unique_lock lock(mutex);
  const auto before = std::exchange(current, std::move(next));
  if (before && calls_deep == 0) returned.wait(lock, [&] { return before->calls == 0; });
  lock.unlock();  // before what the sink held goes
}

void write(Level level, std::string_view line) {
  std::shared_ptr<Listener> listener;
  {
    const std::scoped_lock lock(mutex);
    if (!current) return;
    listener = current;
    ++listener->calls;
  }
  const Call call(*listener);
  listener->sink(level, without_controls(line));
}

}  // namespace liloc::log
