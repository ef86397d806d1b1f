#pragma once
// A ROS 2 bag, message by message: rosbag2 in SQLite, and MCAP with or without zstd and lz4 chunks.
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/stamp.hpp"

namespace liloc::bags {

/// Valid during the call that hands it out.
struct Message {
  std::string_view topic, type;  ///< type e.g. sensor_msgs/msg/Image
  std::string_view cdr;
};
/// An error ends the reading and is passed on.
using OnMessage = std::function<Status(const Message&)>;

/// The files of a bag: of a folder its .db3 and .mcap files by name, else the file itself. Error: there is
/// none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> files_of_bag(const std::filesystem::path& bag);
/// Whether a path is a bag rather than a recording of the layout.
[[nodiscard]] bool is_bag(const std::filesystem::path& path);

/// Hands out all messages of all files, a file after the other. Errors begin with the file: foreign, truncated,
/// damaged, compressed in another way, serialized otherwise than by CDR.
[[nodiscard]] Status read_bag(const std::filesystem::path& bag, const OnMessage& on_message);

[[nodiscard]] Status read_mcap(const std::filesystem::path& file, const OnMessage& on_message);
[[nodiscard]] Status read_sqlite(const std::filesystem::path& file, const OnMessage& on_message);

}  // namespace liloc::bags
