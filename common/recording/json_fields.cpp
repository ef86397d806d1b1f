#include "common/recording/json_fields.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "common/recording/files.hpp"

namespace liloc {
namespace {

constexpr std::size_t kLargestJsonBytes = 4 << 20;  // no site is described by more; by hand
constexpr double kAnyNumber = 1e12;                 // any that a sane file holds; by hand

/// What stands in a field, short enough for one line of an error.
std::string shown(const nlohmann::json& value) {
  std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (text.size() > 40) text = text.substr(0, 37) + "...";
  return text;
}

template <int N>
Result<Eigen::Matrix<double, N, 1>> numbers(const nlohmann::json& object, const char* name,
                                            const std::string& path) {
  const auto found = object.find(name);
  if (found == object.end()) return fail("{} is missing; give {} numbers", path, N);
  if (!found->is_array() || found->size() != N)
    return fail("{} is {}; give {} numbers", path, shown(*found), N);
  Eigen::Matrix<double, N, 1> values;
  for (int i = 0; i < N; ++i) {
    const auto& value = (*found)[static_cast<std::size_t>(i)];
    if (!value.is_number()) return fail("{} is {}; give {} numbers", path, shown(*found), N);
    values[i] = value.get<double>();
  }
  return values;
}

/// A key that stands twice in one object: which of the two was meant nobody can tell.
class DoubledKeys {
 public:
  bool operator()(int /*depth*/, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
    using Event = nlohmann::json::parse_event_t;
    if (event == Event::object_start) open_.emplace_back();
    if (event == Event::object_end) open_.pop_back();
    if (event == Event::key && !open_.back().insert(parsed.get<std::string>()).second && found_.empty())
      found_ = shown(parsed);
    return true;
  }
  [[nodiscard]] const std::string& found() const { return found_; }  ///< empty: none

 private:
  std::vector<std::set<std::string>> open_;  // keys of the objects that are being read
  std::string found_;
};

}  // namespace

Result<std::string> JsonFields::text(const char* name) const {
  if (!has(name)) return fail("{} is missing; give a text", path(name));
  if (!raw(name).is_string()) return fail("{} is {}; give a text", path(name), shown(raw(name)));
  return raw(name).get<std::string>();
}

Result<double> JsonFields::number(const char* name, double low, double high) const {
  if (!has(name)) return fail("{} is missing; give a number", path(name));
  if (!raw(name).is_number()) return fail("{} is {}; give a number", path(name), shown(raw(name)));
  const double value = raw(name).get<double>();
  if (!(value >= low && value <= high)) return fail("{} is {}; must be {}..{}", path(name), value, low, high);
  return value;
}

Result<Pose> JsonFields::pose(const char* name) const {
  if (!has(name)) return fail("{} is missing; give translation and rotation_xyzw", path(name));
  if (!raw(name).is_object())
    return fail("{} is {}; give translation and rotation_xyzw", path(name), shown(raw(name)));
  const auto translation = numbers<3>(raw(name), "translation", path(name) + ".translation");
  if (!translation) return tl::unexpected(translation.error());
  const auto rotation = numbers<4>(raw(name), "rotation_xyzw", path(name) + ".rotation_xyzw");
  if (!rotation) return tl::unexpected(rotation.error());
  return valid_pose(*translation, *rotation, path(name));
}

Result<Camera> JsonFields::camera() const {
  Camera camera;
  for (const auto& [name, target] : {std::pair{"width", &camera.width}, {"height", &camera.height}}) {
    const auto side = number(name, 1, 8192);
    if (!side) return tl::unexpected(side.error());
    if (*side != std::floor(*side)) return fail("{} is {}; give a whole number of pixels", path(name), *side);
    *target = static_cast<int>(*side);
  }
  for (const auto& [name, target] : {std::pair{"fx", &camera.fx},
                                     {"fy", &camera.fy},
                                     {"cx", &camera.cx},
                                     {"cy", &camera.cy},
                                     {"depth_scale", &camera.depth_scale_m}}) {
    const auto value = number(name, -kAnyNumber, kAnyNumber);
    if (!value) return tl::unexpected(value.error());
    *target = *value;
  }
  return camera.validated(where_);
}

Result<nlohmann::json> read_json_object(const std::string& file) {
  const auto bytes = read_file(file, kLargestJsonBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  try {
    DoubledKeys doubled;
    auto object = nlohmann::json::parse(*bytes, std::ref(doubled));
    if (!doubled.found().empty())
      return fail("{}: {} stands twice in one object; remove one", file, doubled.found());
    if (!object.is_object())
      return fail("{}: holds {}; it must be one JSON object {{...}}", file, object.type_name());
    return object;
  } catch (const nlohmann::json::parse_error& error) {  // its text quotes the file, control characters and all
    const auto end = bytes->begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, bytes->size()));
    return fail("{}: line {} is not valid JSON; mend it", file, 1 + std::count(bytes->begin(), end, '\n'));
  } catch (const nlohmann::json::exception&) {
    return fail("{}: a number is out of range; mend it", file);
  }
}

nlohmann::ordered_json pose_to_json(const Pose& T) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  const Eigen::Vector3d t = T.translation();
  return {{"translation", {t.x(), t.y(), t.z()}}, {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

void put_camera(nlohmann::ordered_json& object, const Camera& camera) {
  object["width"] = camera.width;
  object["height"] = camera.height;
  object["fx"] = camera.fx;
  object["fy"] = camera.fy;
  object["cx"] = camera.cx;
  object["cy"] = camera.cy;
  object["depth_scale"] = camera.depth_scale_m;
}

}  // namespace liloc
