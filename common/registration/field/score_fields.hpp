#pragma once
#include <algorithm>
#include <vector>

#include "common/registration/field/score_field.hpp"

namespace liloc {

/// The score fields of a room: one for each of its regions that lie far apart, so that memory follows what is
/// seen and not what lies between.
class ScoreFields {
 public:
  ScoreFields() = default;
  ScoreFields(const std::vector<FieldLayers>& layers, const FieldOptions& options) {
    for (const FieldLayers& region : layers) regions_.emplace_back(region, options);
  }

  /// As ScoreField has it.
  [[nodiscard]] int at(const Eigen::Vector3f& p_map, int plane) const {
    if (regions_.size() == 1) return regions_.front().at(p_map, plane);
    for (const ScoreField& region : regions_)
      if (const int worth = region.at(p_map, plane); worth != 0) return worth;
    return 0;
  }
  void forget_free_space(const VoxelMask& dynamic_mask) {
    for (ScoreField& region : regions_) region.forget_free_space(dynamic_mask);
  }
  [[nodiscard]] bool empty() const {
    return std::ranges::all_of(regions_, [](const ScoreField& region) { return region.empty(); });
  }
  [[nodiscard]] const std::vector<ScoreField>& regions() const { return regions_; }

 private:
  std::vector<ScoreField> regions_;
};

}  // namespace liloc
