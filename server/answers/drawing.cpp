#include <algorithm>
#include <array>
#include <limits>

#include "server/answers/explanation.hpp"

namespace liloc::answers {
namespace {

constexpr double kWidth = 900, kMargin = 30, kMostScale = 150;  // pixels; pixels per metre
constexpr std::size_t kMostPoints = 6000;                       // of a kind: a picture of some 300 kB
constexpr float kLevel = 0.9F;  // floor and ceiling, which would cover all else from above

struct Layer {
  std::string_view name, colour;
};
// Colours that colour-blind eyes tell apart (Okabe and Ito).
constexpr Layer kRoom{"the room", "#cccccc"}, kSeen{"agrees", "#009e73"}, kAgainst{"contradicted", "#d55e00"},
    kMissing{"the ceiling does not see it", "#56b4e9"}, kThrough{"the device looked through it", "#cc79a7"};

/// A view along one axis: which coordinates lie right and up on the paper.
struct View {
  std::string_view title;
  Eigen::Index right, up;
  Eigen::Vector2d low, high;  ///< metres
  double scale = 1, top = 0;  ///< pixels per metre; where it begins on the paper

  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector3d& p) const {
    return {kMargin + (p[right] - low.x()) * scale, top + (high.y() - p[up]) * scale};
  }
  [[nodiscard]] double height() const { return (high.y() - low.y()) * scale; }
};

void grow(const Eigen::Vector3d& p, Eigen::AlignedBox3d* box) {
  if (p.allFinite()) box->extend(p);
}

Eigen::AlignedBox3d box_of(const Cloud& room, const SavedAnswer& saved, const Explanation& explanation) {
  Eigen::AlignedBox3d box;
  for (const auto& p : room.points) grow(p.cast<double>(), &box);
  for (const auto& frame : saved.answered.room->frames()) grow(frame->lidar().T_map_sensor.translation(), &box);
  for (const Pose& T : explanation.again.answer.evidence.T_map_sensors) grow(T.translation(), &box);
  for (const Marked& m : explanation.device) grow(m.p_map.cast<double>(), &box);
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  return {box.min().array() - 0.3, box.max().array() + 0.3};
}

View view_of(std::string_view title, Eigen::Index up, const Eigen::AlignedBox3d& box, double top) {
  View view{title, 0, up, {box.min().x(), box.min()[up]}, {box.max().x(), box.max()[up]}};
  view.scale = std::min(kMostScale, (kWidth - 2 * kMargin) / (view.high.x() - view.low.x()));
  view.top = top;
  return view;
}

/// Points as one path of dots.
class Dots {
 public:
  Dots(const View& view, const Layer& layer, double size_px) : view_(view) {
    svg_ = fmt::format("<path stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" d=\"", layer.colour,
                       size_px);
  }
  void add(const Eigen::Vector3f& p) {
    const Eigen::Vector2d at = view_.at(p.cast<double>());
    svg_ += fmt::format("M{:.0f} {:.0f}h0", at.x(), at.y());
  }
  [[nodiscard]] std::string done() const { return svg_ + "\"/>\n"; }

 private:
  const View& view_;
  std::string svg_;
};

std::string room_dots(const View& view, const Cloud& room) {
  Dots dots(view, kRoom, 2);
  const std::size_t stride = 1 + room.size() / kMostPoints;
  const bool from_above = view.up == 1;
  for (std::size_t i = 0; i < room.size(); i += stride)
    if (!from_above || !room.has_normals() || std::abs(room.normals[i].z()) < kLevel) dots.add(room.points[i]);
  return dots.done();
}

std::string marked_dots(const View& view, const std::vector<Marked>& points, Word word, const Layer& layer) {
  Dots dots(view, layer, 3);
  const std::size_t stride = 1 + points.size() / kMostPoints;
  for (std::size_t i = 0; i < points.size(); i += word == Word::contradicts ? 1 : stride)
    if (points[i].word == word) dots.add(points[i].p_map);
  return dots.done();
}

/// Where it stands and whither it looks.
std::string arrow(const View& view, const Pose& T, std::string_view colour, std::string_view label) {
  const Eigen::Vector2d at = view.at(T.translation());
  const Eigen::Vector2d to = view.at(T.translation() + 0.6 * T.linear().col(2));
  return fmt::format(
      "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"5\" fill=\"{4}\"/><path stroke=\"{4}\" stroke-width=\"2\" "
      "d=\"M{0:.1f} {1:.1f}L{2:.1f} {3:.1f}\"/><text x=\"{5:.1f}\" y=\"{6:.1f}\" fill=\"{4}\">{7}</text>\n",
      at.x(), at.y(), to.x(), to.y(), colour, at.x() + 7, at.y() - 7, label);
}

std::string places(const View& view, const SavedAnswer& saved, const Explanation& explanation) {
  std::string svg;
  for (const auto& frame : saved.answered.room->frames())
    svg += arrow(view, frame->lidar().T_map_sensor, "#888888", frame->lidar().id);
  const auto& found = explanation.again.answer.evidence.T_map_sensors;
  for (std::size_t i = found.size(); i > 0; --i)
    svg += arrow(view, found[i - 1], i == 1 ? "#000000" : "#e69f00", std::to_string(i));
  if (explanation.T_map_sensor)
    svg += arrow(view, *explanation.T_map_sensor, "#0072b2", found.empty() ? "answer" : "");
  return svg;
}

std::string drawn(const View& view, const Cloud& room, const SavedAnswer& saved,
                  const Explanation& explanation) {
  std::string svg = fmt::format("<text x=\"{}\" y=\"{:.0f}\">{}, {:.1f} m wide</text>\n", kMargin, view.top - 6,
                                view.title, view.high.x() - view.low.x());
  svg += room_dots(view, room);
  svg += marked_dots(view, explanation.device, Word::missing, kMissing);
  svg += marked_dots(view, explanation.device, Word::agrees, kSeen);
  svg += marked_dots(view, explanation.ceiling, Word::contradicts, kThrough);
  svg += marked_dots(view, explanation.device, Word::contradicts, kAgainst);
  return svg + places(view, saved, explanation);
}

std::string legend(double y) {
  std::string svg;
  double x = kMargin;
  for (const Layer& layer : {kRoom, kSeen, kAgainst, kMissing, kThrough}) {
    svg += fmt::format(
        "<circle cx=\"{:.0f}\" cy=\"{:.0f}\" r=\"4\" fill=\"{}\"/><text x=\"{:.0f}\" y=\"{:.0f}\">{}</text>\n",
        x, y - 4, layer.colour, x + 8, y, layer.name);
    x += 30 + 7.0 * static_cast<double>(layer.name.size());
  }
  return svg;
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return safe;
}

}  // namespace

std::string to_svg(const SavedAnswer& saved, const Explanation& explanation, const std::string& title) {
  const Cloud& room = saved.answered.room->room()->surfaces()->coarse;
  const Eigen::AlignedBox3d box = box_of(room, saved, explanation);
  const View above = view_of("from above", 1, box, 75);
  const View beside = view_of("from the side (along y)", 2, box, above.top + above.height() + 35);
  const double height = beside.top + beside.height() + kMargin;
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" viewBox=\"0 0 {0} "
             "{1:.0f}\" "
             "font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"{0}\" height=\"{1:.0f}\" "
             "fill=\"white\"/>\n"
             "<text x=\"{2}\" y=\"22\" font-size=\"15\">{3}</text>\n",
             kWidth, height, kMargin, escaped(title)) +
         legend(46) + drawn(above, room, saved, explanation) + drawn(beside, room, saved, explanation) +
         "</svg>\n";
}

}  // namespace liloc::answers
