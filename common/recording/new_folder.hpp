#pragma once
// A folder that appears whole or not at all.
#include <filesystem>
#include <utility>
#include <vector>

#include "common/base/result.hpp"

namespace liloc {

/// Fills a hidden folder beside `target`; unless it is kept, all of it goes again.
class NewFolder {
 public:
  /// Makes the hidden folder, and what lies above it. Errors: `target` is there and no empty folder, or nothing
  /// can be made there.
  [[nodiscard]] static Result<NewFolder> beside(const std::filesystem::path& target);
  NewFolder(NewFolder&& other) noexcept
      : target_(std::move(other.target_)),
        part_(std::exchange(other.part_, {})),
        parents_(std::exchange(other.parents_, {})) {}
  NewFolder& operator=(NewFolder&&) = delete;
  ~NewFolder();

  /// Where to write, until it is kept.
  [[nodiscard]] const std::filesystem::path& path() const { return part_; }
  /// Gives it its name. Error: the system's, and the folder goes when this does.
  [[nodiscard]] Status keep();

 private:
  explicit NewFolder(std::filesystem::path target);
  [[nodiscard]] Status make();
  std::filesystem::path target_, part_;
  std::vector<std::filesystem::path> parents_;  ///< made for it, the highest first
};

}  // namespace liloc
