#include "server/app/remembered_json.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace liloc {
namespace {

using nlohmann::ordered_json;

ordered_json looks_to_json(const LookTerms& looks) {
  return {{"support", looks.support},
          {"contradiction", looks.contradiction},
          {"excess", looks.excess},
          {"misfit", looks.misfit}};
}

Result<LookTerms> looks_from(const JsonFields& fields) {
  LookTerms looks;
  for (const auto& [name, into] :
       {std::pair{"support", &looks.support}, std::pair{"contradiction", &looks.contradiction},
        std::pair{"excess", &looks.excess}, std::pair{"misfit", &looks.misfit}}) {
    const auto value = fields.number(name, -100, 100);
    if (!value) return tl::unexpected(value.error());
    *into = *value;
  }
  return looks;
}

Result<Matrix6d> covariance_from(const JsonFields& fields) {
  const std::string where = fields.path("covariance");
  if (!fields.has("covariance") || !fields.raw("covariance").is_array() ||
      fields.raw("covariance").size() != 36)
    return fail("{} is no list of 36 numbers", where);
  Matrix6d covariance;
  for (Eigen::Index i = 0; i < 36; ++i) {
    const auto& value = fields.raw("covariance").at(static_cast<std::size_t>(i));
    covariance(i / 6, i % 6) = value.is_number() ? value.get<double>() : NAN;
  }
  const bool sound = covariance.allFinite() && covariance.isApprox(covariance.transpose(), 1e-6) &&
                     Eigen::SelfAdjointEigenSolver<Matrix6d>(covariance).eigenvalues().minCoeff() > 0;
  if (!sound) return fail("{} is no covariance", where);
  return covariance;
}

}  // namespace

ordered_json to_json(const Remembered& remembered) {
  const Followed& followed = remembered.followed;
  ordered_json covariance = ordered_json::array();
  for (const double value : followed.estimate.covariance.reshaped()) covariance.push_back(value);
  return {
      {"odom_segment", remembered.odom_segment}, {"T_map_sensor", pose_to_json(followed.estimate.T_map_sensor)},
      {"covariance", std::move(covariance)},     {"T_odom_sensor", pose_to_json(followed.T_odom_sensor)},
      {"log_odds", followed.log_odds},           {"usual", looks_to_json(followed.usual)}};
}

Result<Remembered> remembered_from(const JsonFields& fields) {
  const auto segment = fields.number("odom_segment", 0, 4294967295.0);
  if (!segment) return tl::unexpected(segment.error());
  const auto T_map_sensor = fields.pose("T_map_sensor"), T_odom_sensor = fields.pose("T_odom_sensor");
  if (!T_map_sensor) return tl::unexpected(T_map_sensor.error());
  if (!T_odom_sensor) return tl::unexpected(T_odom_sensor.error());
  const auto covariance = covariance_from(fields);
  if (!covariance) return tl::unexpected(covariance.error());
  const auto log_odds = fields.number("log_odds", -50, 50);
  if (!log_odds) return tl::unexpected(log_odds.error());
  if (!fields.has("usual") || !fields.raw("usual").is_object())
    return fail("{} is missing", fields.path("usual"));
  const auto usual = looks_from(JsonFields(fields.raw("usual"), fields.path("usual")));
  if (!usual) return tl::unexpected(usual.error());
  return Remembered{static_cast<std::uint32_t>(*segment),
                    begun({*T_map_sensor, *covariance}, *T_odom_sensor, *log_odds, *usual)};
}

}  // namespace liloc
