#pragma once
// A folder that appears whole or not at all.
#include <filesystem>
#include <utility>

#include "common/base/result.hpp"

namespace liloc {

/// Fills a hidden folder beside `target`; unless it is kept, all of it goes again.
class NewFolder {
 public:
  /// Errors: `target` is there and no empty folder.
  [[nodiscard]] static Result<NewFolder> beside(const std::filesystem::path& target);
  NewFolder(NewFolder&& other) noexcept
      : target_(std::move(other.target_)), part_(std::exchange(other.part_, {})) {}
  NewFolder& operator=(NewFolder&&) = delete;
  ~NewFolder();

  /// Where to write, until it is kept.
  [[nodiscard]] const std::filesystem::path& path() const { return part_; }
  /// Gives it its name. Error: the system's, and the folder goes.
  [[nodiscard]] Status keep();

 private:
  explicit NewFolder(std::filesystem::path target);
  std::filesystem::path target_, part_;
};

}  // namespace liloc
