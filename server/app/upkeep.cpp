#include "server/app/upkeep.hpp"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>

#include "common/base/log.hpp"

namespace liloc {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPreparePeriod = std::chrono::milliseconds(50);  // a third of a ceiling frame's; by hand
constexpr auto kTrimPeriod = std::chrono::seconds(10);          // a trim takes milliseconds; by hand
constexpr auto kSaveSessionsPeriod = std::chrono::seconds(1);   // about an interval of requests; by hand
constexpr auto kSavePeriod = std::chrono::minutes(1);  // so much is lost with a server that is killed; by hand

/// Gives what clients that left have used back to the system; the C library would keep it.
class HeapTrimmer {
 public:
  void see(std::size_t clients) {
    most_ = std::max(most_, clients);
    const auto now = Clock::now();
    if (clients == most_ || now < next_) return;
    malloc_trim(0);
    most_ = clients;
    next_ = now + kTrimPeriod;
  }

 private:
  std::size_t most_ = 0;  ///< since the last trim
  Clock::time_point next_;
};

}  // namespace

Upkeep::Upkeep(Duties duties)
    : duties_(std::move(duties)), thread_([this](const std::stop_token& stop) { keep(stop); }) {}

void Upkeep::keep(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  auto save_at = Clock::now() + kSavePeriod;
  auto sessions_at = Clock::now() + kSaveSessionsPeriod;
  HeapTrimmer trimmer;
  while (!stop.stop_requested()) {
    const std::size_t clients = duties_.clients();
    trimmer.see(clients);
    try {
      if (clients > 0) duties_.prepare();
    } catch (const std::exception& trouble) {  // the requests will say what is wrong with the room
      log::error("the room's indices were not made: {}", trouble.what());
    }
    if (Clock::now() >= sessions_at) {
      duties_.save_sessions();
      sessions_at = Clock::now() + kSaveSessionsPeriod;
    }
    if (Clock::now() >= save_at) {
      duties_.save_learned();
      save_at += kSavePeriod;
    }
    wake.wait_for(lock, stop, kPreparePeriod, [] { return false; });
  }
}

}  // namespace liloc
