#include "common/base/log.hpp"

#include <memory>
#include <mutex>

#include "common/base/text.hpp"

namespace liloc::log {
namespace {

std::mutex mutex;
std::shared_ptr<const Sink> current;

}  // namespace

Result<Level> level_from(std::string_view name) {
  if (name == "debug") return Level::debug;
  if (name == "info") return Level::info;
  if (name == "warning") return Level::warning;
  if (name == "error") return Level::error;
  return fail("log level is '{}'; must be debug, info, warning or error", name);
}

void set_sink(Sink sink) {
  const std::scoped_lock lock(mutex);
  current = sink ? std::make_shared<const Sink>(std::move(sink)) : nullptr;
}

void write(Level level, std::string_view line) {
  std::shared_ptr<const Sink> sink;
  {
    const std::scoped_lock lock(mutex);
    sink = current;
  }
  if (sink) (*sink)(level, without_controls(line));
}

}  // namespace liloc::log
