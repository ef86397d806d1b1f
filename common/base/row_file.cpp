#include "common/base/row_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace liloc {

RowFile::~RowFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status RowFile::open(const std::filesystem::path& path, std::string_view header) {
  path_ = path;
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    return fail("{}: {}: check the folder's permissions and space", path.string(), std::strerror(errno));
  return append(header);
}

Status RowFile::append(std::string_view row) {
  if (!status_) return status_;
  const std::string line = std::string(row) + '\n';
  std::size_t done = 0;
  while (done < line.size()) {
    const ssize_t written = ::write(descriptor_, line.data() + done, line.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      status_ = fail("{}: {}: nothing more is written to it", path_.string(), std::strerror(errno));
      static_cast<void>(::ftruncate(descriptor_, size_) != 0);  // of a device there is nothing to take back
      return status_;
    }
    done += static_cast<std::size_t>(written);
  }
  size_ += static_cast<std::int64_t>(line.size());
  return {};
}

}  // namespace liloc
