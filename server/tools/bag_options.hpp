#pragma once
// How topics of a bag are given on a command line.
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/recording/bags/convert.hpp"

namespace liloc::toolbox {

struct BagArguments {
  std::vector<std::string> lidars, devices, imus, truths, device_files;  ///< each ID=VALUE
  std::string site, world;
  std::optional<double> still_seconds;

  /// Any but --device and --still-seconds, which are not of bags alone.
  [[nodiscard]] bool any() const {
    return !lidars.empty() || !imus.empty() || !truths.empty() || !device_files.empty() || !site.empty() ||
           !world.empty();
  }
  /// Errors: not ID=VALUE, an id twice, an option that would do nothing.
  [[nodiscard]] Result<bags::ConvertOptions> options() const;
};

/// A line for each topic of which messages were left out, e.g. for a log.
[[nodiscard]] std::vector<std::string> left_out_lines(const bags::Converted& converted);

/// All but --device, which means something else to each command.
void add_bag_options(CLI::App& command, BagArguments& arguments);

}  // namespace liloc::toolbox
