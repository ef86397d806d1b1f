#pragma once
// Options of a program from its command line and from `--config FILE`; whatever is wrong is one line that names
// the flag, or the file and the line.
#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <string>

#include "common/base/result.hpp"

namespace liloc::command {

/// What CLI11 found wrong, in one line: only excerpts of what was given, unknown arguments in their order.
[[nodiscard]] std::string explain(const CLI::App& app, const CLI::ParseError& error);

class ProgramOptions {
 public:
  /// Adds --config. `app` has a name and outlives this.
  explicit ProgramOptions(CLI::App& app);
  ProgramOptions(const ProgramOptions&) = delete;
  ProgramOptions& operator=(const ProgramOptions&) = delete;

  /// The command line wins over the file. On an error `exit_code` is 2 and the message says all; after --help
  /// and --version it is 0 and the message is empty.
  [[nodiscard]] Status parse(int argc, const char* const* argv, int& exit_code);

  /// An error that names flags (`--voxel ...`), as one line; where one came from the file, that is said.
  [[nodiscard]] Error located(const Error& error) const;

 private:
  class File;
  CLI::App& app_;
  CLI::Option* config_ = nullptr;
  std::shared_ptr<File> file_;
};

}  // namespace liloc::command
