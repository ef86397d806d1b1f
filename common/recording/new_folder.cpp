#include "common/recording/new_folder.hpp"

#include <system_error>

namespace liloc {

namespace fs = std::filesystem;

Result<NewFolder> NewFolder::beside(const fs::path& target) {
  std::error_code error;
  if (fs::exists(target, error) && (!fs::is_directory(target, error) || !fs::is_empty(target, error)))
    return fail("{}: is there already; name a new folder", target.string());
  const fs::path name = target.lexically_normal();
  return NewFolder(name.has_filename() ? name : name.parent_path());  // "rec/" is "rec"
}

NewFolder::NewFolder(fs::path target)
    : target_(std::move(target)), part_(target_.parent_path() / ("." + target_.filename().string() + ".part")) {
  std::error_code ignored;
  fs::remove_all(part_, ignored);  // of one that was killed
}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!part_.empty()) fs::remove_all(part_, ignored);
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
