#include "common/recording/private_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <system_error>

#include "common/recording/files.hpp"

namespace liloc {

namespace fs = std::filesystem;

/// `write_file` keeps the mode of the hidden file that it writes first, where that is there.
Status write_private_file(const fs::path& file, std::string_view bytes) {
  const fs::path part = file.parent_path() / ("." + file.filename().string() + ".part");
  std::error_code ignored;  // what is wrong with the folder `write_file` tells
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), ignored);
  fs::remove(part, ignored);
  const int handle = open(part.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (handle >= 0) close(handle);
  if (handle < 0 && fs::exists(file.parent_path(), ignored))
    return fail("{}: cannot be written; check the folder's permissions and free space", file.string());
  return write_file(file, bytes);
}

}  // namespace liloc
