#pragma once
// Follows the traces of a running client, as its own process writes them.
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/recording/recording.hpp"

namespace liloc::toolbox {

/// Hands out the lines that were completed since the last call; the file may not be there yet.
class LineTail {
 public:
  explicit LineTail(std::filesystem::path file) : file_(std::move(file)) {}
  void poll(const std::function<void(const std::string& line)>& on_line);

 private:
  std::filesystem::path file_;
  std::streamoff position_ = 0;
};

/// What a client has told so far.
struct DeviceNews {
  std::vector<StampedPose> poses;                    ///< online poses since the last look, oldest first
  std::size_t asked = 0, verified = 0, refused = 0;  ///< spots since the start
  std::string last_status, last_reason;
  std::vector<double> latencies_ms;  ///< of all answered spots
};

class TraceTail {
 public:
  explicit TraceTail(const std::filesystem::path& folder)
      : online_(folder / "online.tum"), spots_(folder / "spots.csv") {}
  /// Reads on; `poses` holds the new ones alone.
  const DeviceNews& poll();

 private:
  void add_pose(const std::string& line);
  void add_spot(const std::string& line);

  LineTail online_, spots_;
  std::vector<std::string> columns_;  ///< of spots.csv
  DeviceNews news_;
};

}  // namespace liloc::toolbox
