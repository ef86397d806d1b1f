#pragma once
// A saved answer on disk: the request, the room it met, what was remembered, and the answer.
//
// 8 bytes "LILOCANS", a 32-bit version, then one zstd frame with a checksum, which holds the values of
// fields.hpp. Images of the ceiling that several moments share are kept once.
#include <deque>
#include <filesystem>

#include "server/localization/answered.hpp"

namespace liloc::answers {

struct SavedAnswer {
  std::shared_ptr<const std::deque<GlobalLidar>> lidars;  ///< that the rooms below refer to
  Answered answered;
};

/// Pure: no file is touched.
[[nodiscard]] std::string to_bytes(const Answered& answered);
/// Takes at most 512 MiB. Errors: another kind or version of file, a damaged
/// one, values out of range; the message begins with `name`.
[[nodiscard]] Result<SavedAnswer> from_bytes(std::string_view bytes, const std::string& name);
[[nodiscard]] Result<SavedAnswer> read_answer(const std::filesystem::path& file);

}  // namespace liloc::answers
