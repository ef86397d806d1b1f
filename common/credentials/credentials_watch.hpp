#pragma once
#include <map>

#include "common/credentials/credentials.hpp"

namespace liloc {

/// Notices when the files of a folder of credentials are replaced: a certificate renewed, another one revoked.
class CredentialsWatch {
 public:
  /// An empty folder never changes.
  explicit CredentialsWatch(const std::filesystem::path& folder);
  /// True once for each change, when the folder has been the same for two looks: a copy may be under way.
  [[nodiscard]] bool changed();

 private:
  struct Seen {
    std::filesystem::file_time_type written;
    std::uintmax_t bytes = 0;
    friend bool operator==(const Seen&, const Seen&) = default;
  };
  using Look = std::map<std::filesystem::path, Seen>;
  [[nodiscard]] Look look() const;

  Credentials credentials_;
  Look taken_, last_;
};

}  // namespace liloc
