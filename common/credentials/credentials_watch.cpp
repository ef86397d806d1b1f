#include "common/credentials/credentials_watch.hpp"

namespace liloc {

CredentialsWatch::CredentialsWatch(const std::filesystem::path& folder) {
  credentials_.folder = folder;
  taken_ = last_ = look();
}

CredentialsWatch::Look CredentialsWatch::look() const {
  Look now;
  if (credentials_.folder.empty()) return now;
  for (const auto& file : credentials_.files()) {
    std::error_code error;
    const auto written = std::filesystem::last_write_time(file, error);
    const auto bytes = std::filesystem::file_size(file, error);
    if (!error) now[file] = {written, bytes};
  }
  return now;
}

bool CredentialsWatch::changed() {
  Look now = look();
  const bool steady = now == last_;
  last_ = std::move(now);
  if (!steady || last_ == taken_) return false;
  taken_ = last_;
  return true;
}

}  // namespace liloc
