#include "common/wire/log_sink.hpp"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>

#include <chrono>
#include <mutex>
#include <string_view>

#include "common/base/log.hpp"

namespace liloc::wire {
namespace {

class RateLimit {
 public:
  /// How many lines were left out before this one, or -1 to leave it out too.
  int admit() {
    const std::scoped_lock lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    int missed = 0;
    if (now - window_ >= std::chrono::seconds(1)) {
      window_ = now;
      missed = std::exchange(missed_, 0);
      lines_ = 0;
    }
    if (++lines_ <= 10) return missed;
    ++missed_;
    return -1;
  }

 private:
  std::mutex mutex_;
  std::chrono::steady_clock::time_point window_;
  int lines_ = 0, missed_ = 0;
};

void on_line(void* limit, const dds_log_data_t* data) {
  const int missed = static_cast<RateLimit*>(limit)->admit();
  if (missed < 0) return;
  std::string_view text(data->message, data->size);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\0')) text.remove_suffix(1);
  const bool serious = (data->priority & (DDS_LC_ERROR | DDS_LC_FATAL)) != 0;
  const auto level = serious ? log::Level::error : log::Level::warning;
  if (missed > 0) log::write(level, fmt::format("dds: {} lines left out", missed));
  log::write(level, fmt::format("dds: {}", text));
}

}  // namespace

void install_log_sink() {
  static RateLimit limit;
  static std::once_flag once;
  std::call_once(once, [] {
    dds_set_log_mask(DDS_LC_FATAL | DDS_LC_ERROR | DDS_LC_WARNING);
    dds_set_log_sink(on_line, &limit);
  });
}

}  // namespace liloc::wire
