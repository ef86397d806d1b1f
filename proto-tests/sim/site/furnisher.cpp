#include "proto-tests/sim/site/furnisher.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace liloc::sim {
namespace {

using Eigen::Vector2d;
constexpr double kHalfTurn = std::numbers::pi;
constexpr int kTries = 60;                                       // to find a place for a piece
constexpr double kCornerKeptFree = 0.15, kKeptFromLidars = 2.5;  // metres, by hand

}  // namespace

template <class Draw>
void Furnisher::place(const Furniture& piece, double gap_m, Draw draw) {
  for (int i = 0; i < kTries; ++i) {
    const Placement at = draw();
    if (!fits(piece, at, gap_m)) continue;
    if (symmetric_) {
      const Placement twin = opposite(at);
      if (too_close(at, piece.half_size, twin, piece.half_size, gap_m) || !fits(piece, twin, gap_m)) continue;
      items_.push_back({piece, twin, twin, std::nullopt});
    }
    items_.push_back({piece, at, at, std::nullopt});
    return;
  }
}

void Furnisher::along_wall(const Furniture& piece, double gap_m) {
  place(piece, gap_m, [&] {
    const int side = random_.below(4);  // its back (+y) faces the wall: south, east, north, west
    const double length = side % 2 == 0 ? size_.x() : size_.y();
    const double half = piece.half_size.x() + kCornerKeptFree;
    const double along = half < length - half ? random_.uniform(half, length - half) : 0.5 * length;
    const double off = piece.half_size.y() + random_.uniform(0.02, 0.06);
    const Vector2d at[] = {{along, off}, {size_.x() - off, along}, {along, size_.y() - off}, {off, along}};
    const double yaw[] = {kHalfTurn, -0.5 * kHalfTurn, 0, 0.5 * kHalfTurn};
    return Placement{at[side], yaw[side]};
  });
}

void Furnisher::anywhere(const Furniture& piece, double gap_m, bool square) {
  place(piece, gap_m, [&] {
    const double yaw = square ? 0.5 * kHalfTurn * random_.below(4) + 0.05 * random_.normal()
                              : random_.uniform(-kHalfTurn, kHalfTurn);
    return Placement{somewhere(0.5), yaw};
  });
}

/// Where nobody who hangs up a LiDAR would curse it.
void Furnisher::pillar(const Furniture& piece) {
  place(piece, 0.8, [&] {
    Vector2d at = somewhere(1.0);
    for (int i = 0; i < kTries && near_a_lidar(at); ++i) at = somewhere(1.0);
    return Placement{at, 0.02 * random_.normal()};
  });
}

void Furnisher::at_desk(const Furniture& chair, const Item& desk) {
  place(chair, 0.02, [&] {
    const Vector2d front(random_.uniform(-0.3, 0.3), -desk.furniture.half_size.y() - random_.uniform(0.3, 0.5));
    const Eigen::Rotation2Dd turn(desk.start.yaw_rad);
    return Placement{desk.start.at + turn * front, desk.start.yaw_rad + kHalfTurn + 0.4 * random_.normal()};
  });
}

void Furnisher::at(const Furniture& piece, const Placement& there, double gap_m) {
  if (fits(piece, there, gap_m)) place(piece, gap_m, [&] { return there; });
}

bool Furnisher::fits(const Furniture& piece, const Placement& at, double gap_m, const Item* self) const {
  const Eigen::Rotation2Dd turn(at.yaw_rad);
  for (int corner = 0; corner < 4; ++corner) {
    const Vector2d p = at.at + turn * Vector2d((corner & 1 ? 1 : -1) * piece.half_size.x(),
                                               (corner & 2 ? 1 : -1) * piece.half_size.y());
    if (p.x() < 0 || p.y() < 0 || p.x() > size_.x() || p.y() > size_.y()) return false;
  }
  return std::ranges::none_of(items_, [&](const Item& other) {
    if (&other == self) return false;
    const auto hits = [&](const Placement& there) {
      return too_close(at, piece.half_size, there, other.furniture.half_size, gap_m);
    };
    return hits(other.start) || hits(other.reference) || (other.push && hits(other.push->to));
  });
}

Placement Furnisher::opposite(const Placement& p) const {
  return {{size_.x() - p.at.x(), size_.y() - p.at.y()}, p.yaw_rad + kHalfTurn};
}

Vector2d Furnisher::somewhere(double from_wall_m) {
  return {random_.uniform(from_wall_m, size_.x() - from_wall_m),
          random_.uniform(from_wall_m, size_.y() - from_wall_m)};
}

bool Furnisher::near_a_lidar(const Vector2d& at) const {
  for (const double x : {0.0, 0.5, 1.0})
    for (const double y : {0.0, 0.5, 1.0})
      if ((x != 0.5 || y != 0.5) && (Vector2d(x * size_.x(), y * size_.y()) - at).norm() < kKeptFromLidars)
        return true;
  return false;
}

}  // namespace liloc::sim
