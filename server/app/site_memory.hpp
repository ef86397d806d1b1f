#pragma once
#include <memory>
#include <vector>

#include "server/app/site_state.hpp"

namespace liloc {

/// What a server has learned of its site, kept from run to run in the state file. Not thread-safe.
class SiteMemory {
 public:
  /// As `open_site_state` reads it; `file` empty: nothing is kept. `site` outlives it.
  SiteMemory(const std::string& file, const Site& site, double voxel_size_m);

  /// What the run before left.
  [[nodiscard]] const SiteState& at_start() const { return state_; }
  /// What was made of `at_start`: it need not be written.
  void begin(std::shared_ptr<const CellBounds> learned) { saved_ = std::move(learned); }
  /// Writes where there is something new: other bounds, or noise that differs by what matters. A file that
  /// cannot be written is told.
  void save(std::shared_ptr<const CellBounds> learned, std::vector<DepthNoise> noise);

 private:
  const Site& site_;
  const double voxel_size_m_;
  const SiteState state_;
  std::shared_ptr<const CellBounds> saved_;  ///< as the file has it
  std::vector<DepthNoise> saved_noise_;      ///< likewise
};

}  // namespace liloc
