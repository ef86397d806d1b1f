#include "common/credentials/end_of_credentials.hpp"

#include "common/base/log.hpp"

namespace liloc {
namespace {

constexpr auto kEvery = std::chrono::hours(24);  // by hand

}  // namespace

EndOfCredentials::EndOfCredentials(const std::filesystem::path& folder, Time now)
    : folder_(folder), next_(now + kEvery) {
  if (folder_.empty()) return;
  if (auto used = read_credentials(folder_)) used_ = std::move(*used);
}

void EndOfCredentials::look(Time now) {
  if (folder_.empty() || now < next_) return;
  next_ = now + kEvery;
  const auto held = read_credentials(folder_);
  if (!held) return log::error("{}", held.error().message);
  const auto today = std::chrono::system_clock::now();
  warn_of(*held, today);
  if (!used_ || held->expires == used_->expires) return;
  if (const int days = days_left(*used_, today); days < kRenewDays)
    log::warning("{} was renewed; the one in use expires in {} days: start this program again",
                 held->certificate().string(), days);
}

}  // namespace liloc
