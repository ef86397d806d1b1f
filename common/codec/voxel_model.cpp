#include "common/codec/voxel_model.hpp"

namespace liloc::codec {
namespace {

/// What one face or edge neighbour, `X`, `Y`, `Z` away, tells along each axis.
template <int X, int Y, int Z>
void note(std::array<Foretold, 3>& of, const Offset& offset, int steps) {
  constexpr std::array<int, 3> kStep{X, Y, Z};
  constexpr bool kEdge = X * X + Y * Y + Z * Z == 2, kBefore = 9 * Z + 3 * Y + X < 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    (kEdge ? of[axis].edges : of[axis].sides) += kStep[axis];
    if (kBefore && kStep[axis] == 0)
      (kEdge ? of[axis].edge_offsets : of[axis].side_offsets) += 2 * offset[axis] - (steps - 1);
  }
}

}  // namespace

Foresight::Foresight(const std::vector<CellId>& leaves, int steps)
    : leaves_(leaves), steps_(steps), rows_{Walker(leaves, 0, -1, -1), Walker(leaves, -1, 0, -1),
                                            Walker(leaves, 0, 1, -1),  Walker(leaves, -1, -1, 0),
                                            Walker(leaves, -1, 1, 0),  Walker(leaves, 0, -1, 1),
                                            Walker(leaves, -1, 0, 1),  Walker(leaves, 0, 1, 1)} {}

std::array<Foretold, 3> Foresight::operator()(std::size_t i, const std::vector<Offset>& offsets) {
  std::array<Foretold, 3> of{};
  const CellId leaf = leaves_[i];
  const auto single = [&]<int Y, int Z>(Walker& row) {
    if (const std::ptrdiff_t found = row.find(leaf); found >= 0)
      note<0, Y, Z>(of, offsets[static_cast<std::size_t>(found)], steps_);
  };
  const auto triple = [&]<int Y, int Z>(Walker& row) {
    std::size_t at = row.seek(leaf);
    const CellId first = row.wanted(leaf);
    const auto is = [&](CellId wanted) { return at < leaves_.size() && leaves_[at] == wanted; };
    if (is(first)) note<-1, Y, Z>(of, offsets[at++], steps_);
    if (is(first + 1)) note<0, Y, Z>(of, offsets[at++], steps_);
    if (is(first + 2)) note<1, Y, Z>(of, offsets[at], steps_);
  };
  single.template operator()<-1, -1>(rows_[0]);
  triple.template operator()<0, -1>(rows_[1]);
  single.template operator()<1, -1>(rows_[2]);
  triple.template operator()<-1, 0>(rows_[3]);
  if (i > 0 && leaves_[i - 1] == leaf - 1) note<-1, 0, 0>(of, offsets[i - 1], steps_);
  if (i + 1 < leaves_.size() && leaves_[i + 1] == leaf + 1) note<1, 0, 0>(of, offsets[i + 1], steps_);
  triple.template operator()<1, 0>(rows_[4]);
  single.template operator()<-1, 1>(rows_[5]);
  triple.template operator()<0, 1>(rows_[6]);
  single.template operator()<1, 1>(rows_[7]);
  return of;
}

// Weights in 64ths of a voxel, from least squares over simulated sites: a surface leans to where it goes on,
// and a neighbour beside lies about as high.
std::size_t OffsetModel::context(const Foretold& f) const {
  const int voxel = 128 * steps_;  // in 64ths of a half step
  const int place = (8 * f.sides + 3 * f.edges) * 2 * steps_ + 14 * f.side_offsets + 5 * f.edge_offsets;
  const int bucket = std::clamp(place + voxel / 2, 0, voxel - 1) * kPlaces / voxel;
  return static_cast<std::size_t>(2 * bucket + (f.sides != 0 ? 1 : 0));
}

}  // namespace liloc::codec
