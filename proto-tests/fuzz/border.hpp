#pragma once
// A border is where bytes from outside become values of ours: a reader, inputs that it takes, and what they
// must hold once it took them.
#include <functional>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace liloc::fuzz {

struct Border {
  std::string name;                ///< of a target of deploy/fuzz
  std::vector<std::string> seeds;  ///< small inputs that are taken
  /// Hands bytes to the program's own reader. An error is a refusal, as it should be; what the reader takes
  /// although it must not ends the process (`require`).
  std::function<Status(const std::string& bytes)> read;
  /// Makes checksums right again after a change; may be empty.
  std::function<void(std::string& bytes)> mend = {};
};

/// All of them. Makes a DDS participant that stays on loopback, and a folder for files, once.
[[nodiscard]] const std::vector<Border>& borders();

[[nodiscard]] std::vector<Border> cloud_code_borders();
[[nodiscard]] std::vector<Border> message_borders();
[[nodiscard]] std::vector<Border> recording_borders();
[[nodiscard]] std::vector<Border> bag_borders();
[[nodiscard]] std::vector<Border> setting_borders();
[[nodiscard]] std::vector<Border> cloud_file_borders();
[[nodiscard]] std::vector<Border> floor_plan_borders();
[[nodiscard]] std::vector<Border> weights_borders();

/// Ends the process with `what`, which a fuzzer takes for a crash.
void require(bool holds, const char* what);

/// Writes `bytes` to a file of that name in a folder of this process and returns its path.
[[nodiscard]] std::string scratch_file(const std::string& name, const std::string& bytes);

}  // namespace liloc::fuzz
