#include "server/tools/plan/plan_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace liloc::toolbox {
namespace {

using Eigen::Vector2d;
using plan::DeviceModel;

// By hand, all of them.
constexpr double kWidth = 900, kMargin = 30, kTop = 70, kMostScale = 120;  // pixels; pixels per metre
constexpr double kMostCells = 12'000;                                      // of a map: a picture of some 400 kB
constexpr double kUnderCeiling_m = 0.3;  // a ceiling is not drawn: it would cover all else
constexpr int kWallVoxels = 8;           // of a column that is drawn as a wall
constexpr std::size_t kMostTwins = 60;   // of the lines drawn
/// From none to all, to be told apart by colour-blind eyes too (ColorBrewer's PuOr without its middle).
constexpr std::array<std::string_view, 6> kScale{"#b35806", "#f1a340", "#fee0b6",
                                                 "#d8daeb", "#998ec3", "#542788"};

std::string_view colour(double share) {
  const auto step = static_cast<int>(std::clamp(share, 0.0, 0.999) * static_cast<double>(kScale.size()));
  return kScale.at(static_cast<std::size_t>(step));
}

/// Metres of the map to pixels, y up.
struct Paper {
  explicit Paper(const plan::VoxelRoom& room)
      : low(room.low_map().head<2>().cast<double>()),
        size(room.high_map().head<2>().cast<double>() - low),
        scale(std::min(kMostScale, (kWidth - 2 * kMargin) / size.x())) {}
  [[nodiscard]] Vector2d at(const Vector2d& p) const {
    return {kMargin + (p.x() - low.x()) * scale, kTop + (low.y() + size.y() - p.y()) * scale};
  }
  Vector2d low, size;
  double scale;
};

/// Columns of voxels seen from above, gathered into square cells.
struct Cell {
  int voxels = 0, covered = 0, tallest = 0;
  std::map<int, int> columns;  ///< how many voxels stand above each other, by column within the cell
};

struct Cells {
  double side_m = 0.2;
  int width = 0, height = 0;
  std::vector<Cell> cells;
};

Cells cells_of(const PlanInput& input, const std::vector<bool>& covered) {
  const plan::VoxelRoom& room = input.room;
  const Eigen::Vector2f low = room.low_map().head<2>();
  const Vector2d size = (room.high_map().head<2>() - low).cast<double>();
  Cells map;
  map.side_m = plan::kVoxel_m * std::ceil(std::max(2.0, std::sqrt(size.prod() / kMostCells) / plan::kVoxel_m));
  map.width = static_cast<int>(size.x() / map.side_m) + 1;
  map.height = static_cast<int>(size.y() / map.side_m) + 1;
  map.cells.resize(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
  const auto& points = room.cloud_map().points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].z() > input.ceiling_z_m - kUnderCeiling_m) continue;
    const Vector2d p = (points[i].head<2>() - low).cast<double>();
    Cell& cell = map.cells[static_cast<std::size_t>(p.y() / map.side_m) * static_cast<std::size_t>(map.width) +
                           static_cast<std::size_t>(p.x() / map.side_m)];
    ++cell.voxels;
    cell.covered += covered[i] ? 1 : 0;
    const int column =
        static_cast<int>(p.x() / plan::kVoxel_m) + 100'000 * static_cast<int>(p.y() / plan::kVoxel_m);
    cell.tallest = std::max(cell.tallest, ++cell.columns[column]);
  }
  return map;
}

/// A cell's colour; empty where nothing is.
using Paint = std::string (*)(const Cell&);

std::string covered_paint(const Cell& cell) {
  if (cell.voxels == 0) return {};
  return std::string(colour(static_cast<double>(cell.covered) / cell.voxels));
}

std::string wall_paint(const Cell& cell) {
  return cell.tallest >= kWallVoxels ? "#888888" : cell.voxels > 0 ? "#eeeeee" : "";
}

/// Runs of one colour as one rectangle.
std::string painted(const Cells& map, const Paper& paper, Paint paint) {
  std::string svg;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width;) {
      const auto at = [&](int u) -> const Cell& {
        return map.cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
                         static_cast<std::size_t>(u)];
      };
      const std::string fill = paint(at(x));
      int end = x + 1;
      while (end < map.width && paint(at(end)) == fill) ++end;
      const Vector2d corner = paper.at(paper.low + map.side_m * Vector2d(x, y + 1));
      if (!fill.empty())
        svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                           corner.x(), corner.y(), (end - x) * map.side_m * paper.scale,
                           map.side_m * paper.scale, fill);
      x = end;
    }
  return svg;
}

std::string lidars(const PlanFindings& findings, const Paper& paper) {
  std::string svg;
  for (const GlobalLidar& lidar : findings.site.global_lidars) {
    const Pose& T = lidar.T_map_sensor;
    const double half_rad = std::atan(0.5 * lidar.camera.width / lidar.camera.fx);
    const double azimuth_rad = std::atan2(T(1, 2), T(0, 2));
    const Vector2d from = T.translation().head<2>(), at = paper.at(from);
    const auto edge = [&](double side) {
      return paper.at(from + 1.2 * Vector2d(std::cos(azimuth_rad + side), std::sin(azimuth_rad + side)));
    };
    const Vector2d left = edge(half_rad), right = edge(-half_rad);
    svg += fmt::format(
        "<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z\" fill=\"#000\" fill-opacity=\"0.15\" "
        "stroke=\"#000\"/>"
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/><text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        at.x(), at.y(), left.x(), left.y(), right.x(), right.y(), at.x(), at.y(), at.x() + 6, at.y() - 6,
        lidar.id);
  }
  return svg;
}

/// One of the eight sectors around a place.
std::string sector(const Vector2d& at, int direction, double radius, std::string_view fill) {
  const double half = std::numbers::pi / DeviceModel::kDirections, middle = 2 * half * direction;
  const auto edge = [&](double angle) -> Vector2d {
    return at + radius * Vector2d(std::cos(angle), -std::sin(angle));
  };
  const Vector2d a = edge(middle - half), b = edge(middle + half);
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z\" fill=\"{}\"/>\n", at.x(), at.y(),
                     a.x(), a.y(), b.x(), b.y(), fill);
}

std::string places(const PlanInput& input, const PlanFindings& findings, const Paper& paper) {
  const std::size_t count = input.floor.places_map.size();
  std::vector<std::array<double, DeviceModel::kDirections>> chance(count, {0});
  for (std::size_t i = 0; i < findings.devices.views.size(); ++i) {
    const plan::DeviceView& view = findings.devices.views[i];
    chance[view.place].at(static_cast<std::size_t>(view.direction)) +=
        findings.evaluation.chances[i] / static_cast<double>(input.device.heights_m.size());
  }
  const double radius = std::max(3.0, 0.45 * input.floor.spacing_m * paper.scale);
  std::string svg;
  for (std::size_t p = 0; p < count; ++p) {
    const Vector2d at = paper.at(input.floor.places_map[p].cast<double>());
    for (int k = 0; k < DeviceModel::kDirections; ++k)
      svg += sector(at, k, radius, colour(chance[p].at(static_cast<std::size_t>(k))));
    if (findings.evaluation.blind[p])
      svg += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"none\" stroke=\"#d00000\" "
          "stroke-width=\"2\"/>\n",
          at.x(), at.y(), radius);
  }
  return svg;
}

std::string twins(const PlanInput& input, const PlanFindings& findings, const Paper& paper) {
  std::vector<std::pair<double, std::size_t>> strongest;
  for (std::size_t i = 0; i < findings.devices.twins.size(); ++i)
    if (findings.devices.twins[i].alike >= plan::kTwinAlike)
      strongest.emplace_back(-findings.devices.twins[i].alike, i);
  std::ranges::sort(strongest);
  strongest.resize(std::min(strongest.size(), kMostTwins));
  std::string svg;
  for (const auto& [alike, i] : strongest) {
    const auto at = [&](std::size_t view) {
      return paper.at(input.floor.places_map[findings.devices.views[view].place].cast<double>());
    };
    const Vector2d a = at(i), b = at(findings.devices.twins[i].view);
    svg +=
        fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#0072b2\" stroke-dasharray=\"3 3\"/>\n",
                    a.x(), a.y(), b.x(), b.y());
  }
  return svg;
}

std::string page(const Paper& paper, const std::string& title, const std::string& scale_title,
                 const std::string& body) {
  const double height = kTop + paper.size.y() * paper.scale + kMargin;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" viewBox=\"0 0 {0} {1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"{0}\" height=\"{1:.0f}\" fill=\"white\"/>\n"
      "<text x=\"{2}\" y=\"22\" font-size=\"15\">{3}</text>\n<text x=\"{2}\" y=\"46\">{4}</text>\n",
      kWidth, height, kMargin, title, scale_title);
  for (std::size_t i = 0; i < kScale.size(); ++i)
    svg += fmt::format("<rect x=\"{}\" y=\"34\" width=\"24\" height=\"14\" fill=\"{}\"/>\n", 420 + 24 * i,
                       kScale.at(i));
  return svg + body + "</svg>\n";
}

}  // namespace

std::string coverage_svg(const PlanInput& input, const PlanFindings& findings) {
  const Paper paper(input.room);
  const Cells map = cells_of(input, findings.evaluation.covered);
  return page(paper,
              fmt::format("{:.1f} % of the scan is seen by {} LiDARs", 100 * findings.evaluation.coverage,
                          findings.site.global_lidars.size()),
              fmt::format("{:.1f} m wide; seen: none of it ... all", paper.size.x()),
              painted(map, paper, covered_paint) + lidars(findings, paper));
}

std::string localizability_svg(const PlanInput& input, const PlanFindings& findings) {
  const Paper paper(input.room);
  const Cells map = cells_of(input, findings.evaluation.covered);
  return page(paper,
              fmt::format("{:.1f} % of device poses would be verified at once; {:.1f} m2 blind (ringed)",
                          100 * findings.evaluation.localizable, findings.evaluation.blind_m2),
              "chance by direction: 0 ... 1; dashed: places that look alike",
              painted(map, paper, wall_paint) + places(input, findings, paper) + twins(input, findings, paper) +
                  lidars(findings, paper));
}

}  // namespace liloc::toolbox
