#pragma once
#include <cstdint>
#include <vector>

#include "common/registration/features/features.hpp"

namespace liloc {

/// Some of a cloud's descriptors, laid out so that many are compared with one at a time. Immutable; any thread
/// may ask.
class FeatureBlock {
 public:
  /// `columns` of the features.
  FeatureBlock(const Features& features, const std::vector<std::uint32_t>& columns);

  struct Nearest {
    std::uint32_t column = 0;  ///< of the features
    float closeness = -1e30F;  ///< half the square of the descriptor asked for less half its squared distance
  };
  /// For each of the descriptors the nearest of the block, where that is nearer than what `nearest` holds. They
  /// have as many dimensions as the block's.
  void improve(const Features& features, std::vector<Nearest>* nearest) const;

 private:
  std::size_t dimensions_;
  std::vector<std::uint32_t> columns_;
  std::vector<float> groups_;        ///< of 16 descriptors, one dimension after the other
  std::vector<float> half_squared_;  ///< of each; huge where a group is not full
};

}  // namespace liloc
