#pragma once
// What the subcommands of `liloc` share: exit codes, one-line errors, a progress bar.
#include <CLI/CLI.hpp>
#include <string_view>

#include "common/base/result.hpp"
#include "common/base/stamp.hpp"

namespace liloc::toolbox {

enum ExitCode : int { kDone = 0, kFailed = 1, kBadUsage = 2 };

/// Prints `liloc: <message>` on one line of stderr and returns `code`.
int complain(const Error& error, ExitCode code);

/// Draws on stderr when that is a terminal and the work takes over two seconds; otherwise it is silent.
class ProgressBar {
 public:
  explicit ProgressBar(std::string_view label);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();
  /// `share` of the work that is done, 0..1. Cheap enough for every frame.
  void show(double share);

 private:
  const std::string_view label_;
  const bool terminal_;
  Stopwatch watch_;
  double drawn_ms_ = 0;
  bool drawn_ = false;
};

/// Each adds its subcommand to `app`; when it is chosen it runs and sets `exit_code`.
void add_align(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_convert(CLI::App& app, int& exit_code);
void add_doctor(CLI::App& app, int& exit_code);
void add_explain(CLI::App& app, int& exit_code);
void add_record(CLI::App& app, int& exit_code);

}  // namespace liloc::toolbox
