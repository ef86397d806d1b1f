#include "server/tools/plan/dxf_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/recording/files.hpp"
#include "server/tools/plan/dxf_groups.hpp"

namespace liloc::toolbox {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMostWalls = 100'000;  // by hand
constexpr double kArcStep_rad = 0.1;         // of the chords of an arc; by hand

struct Wall {
  Vector2d from, to;  ///< units of the drawing
};

/// Holds at most one wall more than may be, so that a file of few bytes and many chords fills no memory.
class Walls {
 public:
  void put(const Wall& wall) {
    if (!too_many()) all_.push_back(wall);
  }
  [[nodiscard]] bool too_many() const { return all_.size() > kMostWalls; }
  [[nodiscard]] const std::vector<Wall>& all() const { return all_; }

 private:
  std::vector<Wall> all_;
};

/// Metres per unit by $INSUNITS (AutoCAD's DXF reference).
std::optional<double> unit_m(int insunits) {
  switch (insunits) {
    case 1:
      return 0.0254;
    case 2:
      return 0.3048;
    case 4:
      return 0.001;
    case 5:
      return 0.01;
    case 6:
      return 1.0;
    case 14:
      return 0.1;
    default:
      return std::nullopt;
  }
}

void add_arc(const Vector2d& centre, double radius, double from_rad, double turn_rad, Walls& walls) {
  if (!(std::abs(turn_rad) <= 2 * std::numbers::pi)) return;
  const int chords = std::max(1, static_cast<int>(std::ceil(std::abs(turn_rad) / kArcStep_rad)));
  const auto at = [&](int i) -> Vector2d {
    const double angle = from_rad + turn_rad * i / chords;
    return centre + radius * Vector2d(std::cos(angle), std::sin(angle));
  };
  for (int i = 0; i < chords; ++i) walls.put({at(i), at(i + 1)});
}

/// A leg of a polyline: straight, or an arc whose bulge is the tangent of a quarter of its angle.
void add_leg(const Vector2d& from, const Vector2d& to, double bulge, Walls& walls) {
  if (std::abs(bulge) < 1e-6 || (to - from).norm() <= 0) {
    walls.put({from, to});
    return;
  }
  const double turn_rad = 4 * std::atan(bulge);
  const Vector2d chord = to - from, across(-chord.y(), chord.x());
  const Vector2d centre = 0.5 * (from + to) + across * (1 - bulge * bulge) / (4 * bulge);
  const Vector2d start = from - centre;
  add_arc(centre, start.norm(), std::atan2(start.y(), start.x()), turn_rad, walls);
}

struct Vertex {
  Vector2d at;
  double bulge = 0;
};

void add_polyline(const std::vector<Vertex>& vertices, bool closed, Walls& walls) {
  for (std::size_t i = 0; i + 1 < vertices.size() && !walls.too_many(); ++i)
    add_leg(vertices[i].at, vertices[i + 1].at, vertices[i].bulge, walls);
  if (closed && vertices.size() > 2)
    add_leg(vertices.back().at, vertices.front().at, vertices.back().bulge, walls);
}

/// The vertices of an LWPOLYLINE: each begins with its x.
std::vector<Vertex> vertices_of(const DxfEntity& entity) {
  std::vector<Vertex> vertices;
  for (const DxfGroup& group : entity.groups) {
    if (group.code == 10) vertices.push_back({{group.number, 0}});
    if (vertices.empty()) continue;
    if (group.code == 20) vertices.back().at.y() = group.number;
    if (group.code == 42) vertices.back().bulge = group.number;
  }
  return vertices;
}

bool is_closed(const DxfEntity& entity) {
  return std::fmod(std::abs(entity.number(70)), 2) >= 1;
}

/// Whether it is of a sheet with its frame and title block, whose units are not the model's.
bool is_of_paper_space(const DxfEntity& entity) {
  return entity.number(67) == 1;
}

/// Turns entities of the model into walls; POLYLINE goes on over the VERTEX entities that follow it.
class Drawing {
 public:
  void add(const DxfEntity& e) {
    if (e.type == "VERTEX") {
      if (open_ && vertices_.size() <= kMostWalls)
        vertices_.push_back({{e.number(10), e.number(20)}, e.number(42)});
      return;
    }
    end_polyline();
    if (is_of_paper_space(e)) return;
    const Vector2d at(e.number(10), e.number(20));
    if (e.type == "LINE") walls_.put({at, {e.number(11), e.number(21)}});
    if (e.type == "LWPOLYLINE") add_polyline(vertices_of(e), is_closed(e), walls_);
    if (e.type == "POLYLINE") open_ = true, closed_ = is_closed(e);
    if (e.type == "CIRCLE") add_arc(at, e.number(40), 0, 2 * std::numbers::pi, walls_);
    if (e.type == "ARC") {
      const double from = radians(e.number(50)), to = radians(e.number(51));
      const double turn =
          std::fmod(std::fmod(to - from, 2 * std::numbers::pi) + 2 * std::numbers::pi, 2 * std::numbers::pi);
      add_arc(at, e.number(40), from, turn, walls_);
    }
  }
  /// What is still open ends.
  void finish() { end_polyline(); }
  [[nodiscard]] bool too_many() const { return walls_.too_many() || vertices_.size() > kMostWalls; }
  [[nodiscard]] const std::vector<Wall>& walls() const { return walls_.all(); }

 private:
  void end_polyline() {
    if (open_) add_polyline(vertices_, closed_, walls_);
    open_ = false;
    vertices_.clear();
  }
  Walls walls_;
  std::vector<Vertex> vertices_;
  bool open_ = false, closed_ = false;
};

Result<plan::Outline> drawn(const std::vector<Wall>& walls, double scale_m) {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::max()), high = -low;
  for (const Wall& wall : walls)
    for (const Vector2d& p : {wall.from, wall.to}) {
      low = low.cwiseMin(scale_m * p);
      high = high.cwiseMax(scale_m * p);
    }
  auto outline = plan::blank_outline(low, high);
  if (!outline) return outline;
  for (const Wall& wall : walls) plan::draw_wall(*outline, scale_m * wall.from, scale_m * wall.to);
  return outline;
}

}  // namespace

Result<plan::Outline> read_dxf(const std::filesystem::path& file, std::optional<double> scale_m) {
  const std::string name = file.string();
  const auto too_many = [&] {
    return fail("{}: draws over {} walls; leave furniture and hatches out", name, kMostWalls);
  };
  Drawing drawing;
  std::optional<double> unit;
  const Status read = read_dxf_entities(file, [&](const DxfEntity& entity) -> Status {
    if (entity.type == "$INSUNITS") unit = unit_m(static_cast<int>(std::clamp(entity.number(70), -1.0, 99.0)));
    drawing.add(entity);
    return drawing.too_many() ? Status(too_many()) : Status{};
  });
  if (!read) return tl::unexpected(read.error());
  drawing.finish();
  if (drawing.too_many()) return too_many();
  if (drawing.walls().empty())
    return fail("{}: draws no wall as LINE, LWPOLYLINE, POLYLINE, ARC or CIRCLE; explode its blocks", name);
  const std::optional<double> scale = scale_m ? scale_m : unit;
  if (!scale) return fail("{}: tells no unit ($INSUNITS); give --scale, the metres of one unit", name);
  auto outline = drawn(drawing.walls(), *scale);
  if (!outline) return fail("{}: {}", name, outline.error().message);
  return outline;
}

}  // namespace liloc::toolbox
