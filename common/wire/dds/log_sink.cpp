#include "common/wire/dds/log_sink.hpp"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>

#include <chrono>
#include <mutex>
#include <string_view>

#include "common/base/line_limit.hpp"
#include "common/base/log.hpp"

namespace liloc::wire {
namespace {

struct Limit {
  std::mutex mutex;
  SourceLimit lines;  // by their text: a stranger's attempts are all alike
};

void on_line(void* argument, const dds_log_data_t* data) {
  std::string_view text(data->message, data->size);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\0')) text.remove_suffix(1);
  auto& limit = *static_cast<Limit*>(argument);
  std::unique_lock lock(limit.mutex);
  const auto held = limit.lines.pass(std::string(text), std::chrono::steady_clock::now());
  lock.unlock();
  if (!held) return;
  const bool serious = (data->priority & (DDS_LC_ERROR | DDS_LC_FATAL)) != 0;
  log::write(serious ? log::Level::error : log::Level::warning,
             fmt::format("dds: {}{}", text, held_back(*held)));
}

}  // namespace

void install_log_sink() {
  static Limit limit;
  static std::once_flag once;
  std::call_once(once, [] {
    dds_set_log_mask(DDS_LC_FATAL | DDS_LC_ERROR | DDS_LC_WARNING);
    dds_set_log_sink(on_line, &limit);
  });
}

}  // namespace liloc::wire
