#pragma once
// A program as a user runs it.
#include <string>

namespace liloc {

struct Outcome {
  int exit_code = -1;  ///< -1: it could not be started, or died of a signal
  std::string out;     ///< stdout and stderr
};

/// Runs a program with arguments as a shell takes them, to its end or for two minutes (exit code 124).
[[nodiscard]] Outcome run_program(const std::string& program, const std::string& arguments);

}  // namespace liloc
