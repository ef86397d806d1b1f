#include "common/base/log.hpp"

#include <memory>
#include <mutex>

namespace liloc::log {
namespace {

std::mutex mutex;
std::shared_ptr<const Sink> current;

}  // namespace

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
  if (sink) (*sink)(level, line);
}

}  // namespace liloc::log
