#include "common/recording/new_folder.hpp"

#include <system_error>

namespace liloc {

namespace fs = std::filesystem;

Result<NewFolder> NewFolder::beside(const fs::path& target) {
  std::error_code error;
  if (fs::exists(target, error) && (!fs::is_directory(target, error) || !fs::is_empty(target, error)))
    return fail("{}: is there already; name a new folder", target.string());
  const fs::path name = target.lexically_normal();
  NewFolder folder(name.has_filename() ? name : name.parent_path());  // "rec/" is "rec"
  if (const Status made = folder.make(); !made) return tl::unexpected(made.error());
  return folder;
}

NewFolder::NewFolder(fs::path target)
    : target_(std::move(target)), part_(target_.parent_path() / ("." + target_.filename().string() + ".part")) {
  std::error_code ignored;
  fs::remove_all(part_, ignored);  // of one that was killed
}

Status NewFolder::make() {
  std::error_code error;
  for (fs::path above = part_.parent_path(); !above.empty() && !fs::exists(above, error);
       above = above.parent_path())
    parents_.insert(parents_.begin(), above);
  fs::create_directories(part_, error);
  if (!error) return {};
  return fail("{}: cannot be made ({}); choose another place", target_.string(), error.message());
}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (part_.empty()) return;
  fs::remove_all(part_, ignored);
  for (; !parents_.empty(); parents_.pop_back()) fs::remove(parents_.back(), ignored);  // empty ones
}

Status NewFolder::keep() {
  std::error_code error;
  fs::remove(target_, error);  // an empty one
  fs::rename(part_, target_, error);
  if (error) return fail("{}: cannot be made ({}); name another", target_.string(), error.message());
  part_.clear();
  return {};
}

}  // namespace liloc
