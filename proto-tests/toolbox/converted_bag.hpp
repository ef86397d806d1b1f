#pragma once
#include <filesystem>

#include "common/recording/convert_error.hpp"
#include "proto-tests/replay/options.hpp"
#include "server/tools/bag_options.hpp"

namespace liloc::toolbox {

/// A bag as a recording, in a folder that lives as long as this.
class ConvertedBag {
 public:
  ConvertedBag() = default;
  ConvertedBag(const ConvertedBag&) = delete;
  ConvertedBag& operator=(const ConvertedBag&) = delete;
  ~ConvertedBag();

  /// Where `options.recording` is a bag, converts it, takes --device for its topics and puts the recording in
  /// its place. Errors: options of bags for what is none, a bag that cannot be converted, a stop signal.
  [[nodiscard]] Conversion<void> take(replay::ReplayOptions& options, BagArguments bag);

 private:
  std::filesystem::path folder_;
};

}  // namespace liloc::toolbox
