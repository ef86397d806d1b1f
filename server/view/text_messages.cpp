#include "server/view/text_messages.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/log_level.hpp"

namespace liloc::view {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRange_m = DepthOptions{}.max_range_m;

/// Three digits are enough to draw; what is no number is null.
Json digits(double value, double per_unit = 1e3) {
  return std::isfinite(value) ? Json(std::round(value * per_unit) / per_unit) : Json();
}

Json digits(const std::optional<double>& value) {
  return value ? digits(*value) : Json();
}

Json pose_json(const Pose& T) {
  const Eigen::Quaterniond q(T.linear());
  const auto& t = T.translation();
  Json numbers = Json::array();
  for (const double v : {t.x(), t.y(), t.z()}) numbers.push_back(digits(v));
  for (const double v : {q.x(), q.y(), q.z(), q.w()}) numbers.push_back(digits(v, 1e5));
  return numbers;
}

/// Of the position: its block of a covariance in the sensor frame.
Json axes_json(const Pose& T_map_sensor, const Matrix6d& covariance) {
  const Eigen::Matrix3d in_map =
      T_map_sensor.linear() * covariance.bottomRightCorner<3, 3>() * T_map_sensor.linear().transpose();
  Json numbers = Json::array();
  if (!in_map.allFinite()) return numbers;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(in_map);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis =
        solved.eigenvectors().col(i) * std::sqrt(std::max(0.0, solved.eigenvalues()[i]));
    for (const double v : axis) numbers.push_back(digits(v, 1e4));
  }
  return numbers;
}

std::string text_of(const Json& json) {  // a log may hold what is no UTF-8
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json lidar_json(const web::LidarFacts& lidar) {
  const wire::LidarHealth& health = lidar.health;
  return {{"state", wire::name_of(health.state)},
          {"hz", digits(health.measured_hz)},
          {"age_s", digits(lidar.age_s)},
          {"returns", digits(health.returns)},
          {"frames", health.frames},
          {"malformed", health.malformed},
          {"error", health.last_error}};
}

Json device_json(const DeviceState& device, std::chrono::steady_clock::time_point now) {
  const SpotReply& last = device.last;
  Json json{{"id", last.client_id},
            {"status", name_of(last.status)},
            {"reason", name_of(last.reason)},
            {"advice", name_of(last.advice)},
            {"text", last.text},
            {"confidence", digits(device.confidence, 1e5)},
            {"overlap", digits(last.overlap)},
            {"fitness", digits(last.fitness)},
            {"latency_ms", digits(last.latency_ms)},
            {"age_s", digits(std::chrono::duration<double>(now - device.at).count())},
            {"answers", device.answers},
            {"pose", nullptr},
            {"scan", nullptr}};
  if (device.scan_seq) json["scan"] = *device.scan_seq;
  if (!device.T_map_sensor) return json;
  json["pose"] = pose_json(*device.T_map_sensor);
  json["axes"] = axes_json(*device.T_map_sensor, device.covariance);
  json["pose_verified"] = device.pose_verified;
  return json;
}

}  // namespace

std::string site_message(const Site& site, const web::ServerFacts& facts) {
  Json lidars = Json::array();
  for (const GlobalLidar& lidar : site.global_lidars) {
    const Camera& c = lidar.camera;
    lidars.push_back({{"id", lidar.id},
                      {"pose", pose_json(lidar.T_map_sensor)},
                      {"view",
                       {digits(-c.cx / c.fx), digits((c.width - c.cx) / c.fx), digits(-c.cy / c.fy),
                        digits((c.height - c.cy) / c.fy)}},
                      {"range", kRange_m}});
  }
  return text_of({{"part", "site"},
                  {"server", facts.server_id},
                  {"version", facts.version},
                  {"frame", site.world_frame},
                  {"lidars", std::move(lidars)}});
}

std::string now_message(const web::ServerFacts& facts, const Devices& devices,
                        std::chrono::steady_clock::time_point now) {
  Json lidars = Json::array(), told = Json::array();
  for (const auto& lidar : facts.lidars) lidars.push_back(lidar_json(lidar));
  for (const auto& device : devices) told.push_back(device_json(*device, now));
  return text_of({{"part", "now"},
                  {"uptime_s", digits(facts.uptime_s)},
                  {"gpc_age_s", digits(web::gpc_age_s(facts))},
                  {"clients", facts.clients},
                  {"queued", facts.service.queued},
                  {"answered", facts.service.answered},
                  {"verified", facts.service.verified},
                  {"refused", facts.service.refused},
                  {"lidars", std::move(lidars)},
                  {"devices", std::move(told)}});
}

std::string trails_message(const Devices& devices) {
  Json of = Json::object();
  for (const auto& device : devices) {
    Json& trail = of[device->last.client_id] = Json::array();
    for (const Eigen::Vector3f& p : device->trail_map)
      for (const float v : p) trail.push_back(std::lround(100 * v));
  }
  return text_of({{"part", "trails"}, {"of", std::move(of)}});
}

std::string charts_message(const std::vector<ChartColumn>& columns) {
  Json json{{"part", "charts"}, {"column_s", kColumn.count()}};
  for (const char* row : {"verified", "provisional", "refused", "median_ms", "p95_ms"})
    json[row] = Json::array();
  for (const ChartColumn& column : columns) {
    json["verified"].push_back(column.verified);
    json["provisional"].push_back(column.provisional);
    json["refused"].push_back(column.refused);
    json["median_ms"].push_back(digits(column.median_ms));
    json["p95_ms"].push_back(digits(column.p95_ms));
  }
  return text_of(json);
}

std::string log_message(const std::vector<LogLine>& lines) {
  Json told = Json::array();
  for (const LogLine& line : lines) {
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(line.at.time_since_epoch()).count();
    told.push_back({ms, log::name_of(line.level), line.text});
  }
  return text_of({{"part", "log"}, {"lines", std::move(told)}});
}

}  // namespace liloc::view
