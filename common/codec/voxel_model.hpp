#pragma once
// Private to the room: what the voxel coder expects. Each function walks over a stream in either direction:
// with a RangeEncoder it writes what it is given, with a RangeDecoder it fills it in.
#include <algorithm>
#include <array>
#include <memory>

#include "common/codec/cells.hpp"
#include "common/codec/range_coder.hpp"
#include "common/codec/voxel.hpp"

namespace liloc::codec {

/// Which children of a level's cells are occupied. A child's context is, along each axis, what is known of the
/// place beyond it: in its parent (a sibling) and outside (the next cell and, where that came before, its
/// child).
class OccupancyModel {
 public:
  /// `above_leaves`: levels between these cells and the leaves, 0 for the last. `masks` as long as `cells`.
  template <class Coder>
  void code(Coder& coder, const std::vector<CellId>& cells, std::vector<std::uint8_t>& masks,
            int above_leaves) {
    auto& models = models_[static_cast<std::size_t>(std::min(above_leaves, 2))];
    std::array<Walker, 6> around{Walker(cells, -1, 0, 0), Walker(cells, 1, 0, 0),  Walker(cells, 0, -1, 0),
                                 Walker(cells, 0, 1, 0),  Walker(cells, 0, 0, -1), Walker(cells, 0, 0, 1)};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::array<int, 6> outside{};  // before: the neighbour's mask, or -1; behind: 0 where there is one, or -1
      for (std::size_t side = 0; side < 6; ++side) {
        const auto found = around[side].find(cells[i]);
        outside[side] = found < 0 ? -1 : side % 2 == 0 ? masks[static_cast<std::size_t>(found)] : 0;
      }
      unsigned mask = 0;
      for (unsigned child = 0; child < 8; ++child) {
        const bool certain = child == 7 && mask == 0;  // no cell is empty
        const bool wanted = masks[i] >> child & 1;
        if (certain || coder.bit(models[context(child, mask, outside)], wanted)) mask |= 1U << child;
      }
      masks[i] = static_cast<std::uint8_t>(mask);
    }
  }

 private:
  static constexpr std::size_t kStates = 12;  ///< kinds of a neighbour, as `state` counts them

  static std::size_t context(unsigned child, unsigned mask, const std::array<int, 6>& outside) {
    std::array<std::size_t, 3> state{};
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned across = child ^ 1U << axis, upper = child >> axis & 1;
      const int next = outside[2 * axis + upper];
      const std::size_t beyond = next < 0     ? 0
                                 : upper == 1 ? 1
                                              : 2 + (static_cast<unsigned>(next) >> across & 1);
      const std::size_t sibling = across > child ? 0 : 1 + (mask >> across & 1);
      state[axis] = beyond * 3 + sibling;
    }
    if (state[0] > state[1]) std::swap(state[0], state[1]);  // the axes are alike
    if (state[1] > state[2]) std::swap(state[1], state[2]);
    if (state[0] > state[1]) std::swap(state[0], state[1]);
    return (state[0] * kStates + state[1]) * kStates + state[2];
  }

  std::array<std::array<BitModel, kStates * kStates * kStates>, 3> models_;
};

/// Where a point lies in its voxel, in steps from the lower corner.
using Offset = std::array<std::uint8_t, 3>;

/// What the voxels around a point's own tell of it along one axis: surfaces go on.
struct Foretold {
  int sides = 0, edges = 0;                ///< occupied face and edge neighbours above less those below
  int side_offsets = 0, edge_offsets = 0;  ///< sums of the known offsets beside, from the middle, in half steps
};

/// Foretells the points of sorted leaves, asked in their order.
class Foresight {
 public:
  Foresight(const std::vector<CellId>& leaves, int steps);
  /// Of leaf `i`; `offsets` of those before it are known.
  [[nodiscard]] std::array<Foretold, 3> operator()(std::size_t i, const std::vector<Offset>& offsets);

 private:
  const std::vector<CellId>& leaves_;
  int steps_;
  std::array<Walker, 8> rows_;  ///< along x, around the leaf's own
};

class OffsetModel {
 public:
  explicit OffsetModel(int steps) : steps_(steps) {}

  template <class Coder>
  Offset code(Coder& coder, const std::array<Foretold, 3>& foretold, const Offset& wanted) {
    Offset offset{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      offset[axis] = static_cast<std::uint8_t>(symbol(coder, models_[context(foretold[axis])], wanted[axis]));
    return offset;
  }
  /// Whether one more point follows in the same voxel.
  template <class Coder>
  bool code_again(Coder& coder, bool wanted) {
    return coder.bit(again_, wanted);
  }

 private:
  static constexpr int kPlaces = 9;  ///< kinds of neighbourhoods
  using Tree = std::array<BitModel, 2 * kMaxSteps>;

  /// By halving what is left of 0..steps; between the last two nothing is foretold.
  template <class Coder>
  int symbol(Coder& coder, Tree& tree, int wanted) {
    int low = 0, left = steps_;
    std::size_t node = 1;
    while (left > 2) {
      const int half = left / 2;
      const bool upper = coder.bit(tree[node], wanted >= low + half);
      low += upper ? half : 0;
      left = upper ? left - half : half;
      node = 2 * node + (upper ? 1 : 0);
    }
    return low + (left == 2 && coder.plain_bit(wanted > low) ? 1 : 0);
  }
  [[nodiscard]] std::size_t context(const Foretold& f) const;

  int steps_;
  std::array<Tree, 2 * kPlaces> models_;
  BitModel again_;
};

}  // namespace liloc::codec
