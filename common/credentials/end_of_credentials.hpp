#pragma once
#include <chrono>
#include <filesystem>
#include <optional>

#include "common/credentials/credentials.hpp"

namespace liloc {

/// Says once a day what is wrong with the credentials of a program that runs on: what `warn_of` says, what
/// makes their folder unusable, or that the folder has newer ones, which are read at the next start. Not
/// thread-safe.
class EndOfCredentials {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// What `folder` holds now is what the program uses; who reads it at the start warns of it then. An empty one
  /// is never spoken of.
  EndOfCredentials(const std::filesystem::path& folder, Time now);
  /// To be called now and then.
  void look(Time now);

 private:
  std::filesystem::path folder_;
  std::optional<Credentials> used_;
  Time next_;
};

}  // namespace liloc
