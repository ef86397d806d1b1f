#pragma once
// Typed access to a JSON object whose every error names the file, the field and the remedy.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "common/geometry/camera.hpp"

namespace liloc {

class JsonFields {
 public:
  /// `where` is the file and, inside lists, the element, e.g. "site.json: global_lidars[1]".
  JsonFields(const nlohmann::json& object, std::string where) : object_(object), where_(std::move(where)) {}

  [[nodiscard]] bool has(const char* name) const { return object_.contains(name); }
  [[nodiscard]] std::string path(std::string_view name) const { return where_ + "." + std::string(name); }
  [[nodiscard]] const nlohmann::json& raw(const char* name) const { return object_.at(name); }

  [[nodiscard]] Result<std::string> text(const char* name) const;
  /// A finite number in [low, high].
  [[nodiscard]] Result<double> number(const char* name, double low, double high) const;
  /// {"translation": [x y z], "rotation_xyzw": [x y z w]}
  [[nodiscard]] Result<Pose> pose(const char* name) const;
  /// width, height, fx, fy, cx, cy, depth_scale
  [[nodiscard]] Result<Camera> camera() const;

 private:
  const nlohmann::json& object_;
  std::string where_;
};

/// Parses a file that holds one JSON object.
[[nodiscard]] Result<nlohmann::json> read_json_object(const std::string& file);

[[nodiscard]] nlohmann::ordered_json pose_to_json(const Pose& T);
void put_camera(nlohmann::ordered_json& object, const Camera& camera);

}  // namespace liloc
