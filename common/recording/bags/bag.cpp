#include "common/recording/bags/bag.hpp"

#include <algorithm>
#include <system_error>

namespace liloc::bags {
namespace {

namespace fs = std::filesystem;

bool has_bag_name(const fs::path& file) {
  return file.extension() == ".mcap" || file.extension() == ".db3";
}

}  // namespace

Result<std::vector<fs::path>> files_of_bag(const fs::path& bag) {
  std::error_code error;
  if (!fs::exists(bag, error)) return fail("{}: no such file; check the path", bag.string());
  if (!fs::is_directory(bag, error)) {
    if (!fs::is_regular_file(bag, error) || !has_bag_name(bag))
      return fail("{}: is no bag; give a .mcap or .db3 file, or the folder of one", bag.string());
    return std::vector{bag};
  }
  std::vector<fs::path> files;
  for (fs::directory_iterator it(bag, error), end; !error && it != end; it.increment(error))
    if (std::error_code unknown; has_bag_name(it->path()) && fs::is_regular_file(it->path(), unknown))
      files.push_back(it->path());
  std::ranges::sort(files);
  if (files.empty())
    return fail("{}: holds no .mcap or .db3 file; give the folder of a bag, and unpack .zstd files first",
                bag.string());
  return files;
}

bool is_bag(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error))
    return !fs::exists(path / "site.json", error) && files_of_bag(path).has_value();
  return has_bag_name(path);
}

Status read_bag(const fs::path& bag, const OnMessage& on_message) {
  const auto files = files_of_bag(bag);
  if (!files) return tl::unexpected(files.error());
  for (const fs::path& file : *files) {
    const Status read =
        file.extension() == ".mcap" ? read_mcap(file, on_message) : read_sqlite(file, on_message);
    if (!read) return read;
  }
  return {};
}

}  // namespace liloc::bags
