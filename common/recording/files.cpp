#include "common/recording/files.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace liloc {

namespace fs = std::filesystem;

Result<std::string> read_file(const fs::path& file, std::size_t limit_bytes) {
  std::error_code error;
  const auto status = fs::status(file, error);
  if (!fs::exists(status)) return fail("{}: no such file; check the path", file.string());
  if (!fs::is_regular_file(status)) return fail("{}: not a regular file; check the path", file.string());
  const auto size = fs::file_size(file, error);
  if (error) return fail("{}: cannot be read: {}; check its permissions", file.string(), error.message());
  if (size > limit_bytes)
    return fail("{}: has {} bytes, at most {} are expected; is it the right file?", file.string(), size,
                limit_bytes);
  std::ifstream in(file, std::ios::binary);
  std::string bytes(size, '\0');
  if (!in || !in.read(bytes.data(), static_cast<std::streamsize>(size)))
    return fail("{}: cannot be read; check its permissions", file.string());
  return bytes;
}

Status write_file(const fs::path& file, std::string_view bytes) {
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  if (error)
    return fail("{}: its folder cannot be made: {}; choose another place", file.string(), error.message());
  const fs::path part = file.parent_path() / ("." + file.filename().string() + ".part");
  errno = 0;  // streams say that they failed, the system says why
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) {
    const std::string reason = errno == 0 ? "the stream failed" : std::strerror(errno);
    fs::remove(part, error);
    return fail("{}: cannot be written: {}; check the folder's permissions and free space", file.string(),
                reason);
  }
  fs::rename(part, file, error);
  if (!error) return {};
  const std::string reason = error.message();
  fs::remove(part, error);
  return fail("{}: cannot be written: {}; check what stands in its place", file.string(), reason);
}

}  // namespace liloc
