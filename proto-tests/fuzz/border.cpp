#include "proto-tests/fuzz/border.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace liloc::fuzz {
namespace {

namespace fs = std::filesystem;

class ScratchFolder {
 public:
  ScratchFolder()
      : path_((fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path()) /
              fmt::format("liloc_fuzz_{}", ::getpid())) {
    fs::create_directories(path_);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::vector<Border> all_borders() {
  std::vector<Border> all;
  for (const auto make : {cloud_code_borders, message_borders, recording_borders, bag_borders, setting_borders,
                          cloud_file_borders, floor_plan_borders, weights_borders}) {
    std::vector<Border> some = make();
    std::move(some.begin(), some.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace

const std::vector<Border>& borders() {
  static const std::vector<Border> all = all_borders();
  return all;
}

void require(bool holds, const char* what) {
  if (holds) return;
  fmt::print(stderr, "taken, but {}\n", what);
  std::abort();
}

std::string scratch_file(const std::string& name, const std::string& bytes) {
  static const ScratchFolder folder;
  const fs::path file = folder.path() / name;
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  return file.string();
}

}  // namespace liloc::fuzz
