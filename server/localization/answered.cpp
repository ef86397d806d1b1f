#include "server/localization/answered.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

constexpr double kGravityOff_rad = radians(5.0);  // by hand

/// A verified pose shows whether what the device takes for gravity is right.
void note_gravity(const Spot& spot, SpotReply* reply) {
  if (!reply->verified() || !spot.request().up_sensor) return;
  const Eigen::Vector3d up_map = reply->T_map_sensor->linear() * *spot.request().up_sensor;
  const double off_rad = std::acos(std::clamp(up_map.dot(spot.snapshot()->room()->up_map()), -1.0, 1.0));
  if (off_rad > kGravityOff_rad)
    reply->text += fmt::format("; the device's gravity is off by {:.0f} deg and was dropped", degrees(off_rad));
}

}  // namespace

Result<std::shared_ptr<const Spot>> spot_of(DeviceSession& session, const SpotRequest& request,
                                            std::shared_ptr<const Snapshot> room,
                                            const LocalizerOptions& options,
                                            std::shared_ptr<const CellBounds> bounds) {
  if (request.cold || options.method != Method::liloc)
    return Spot::create(request, std::move(room), options, std::move(bounds));
  // A pose that is followed rests on odometry: what odometry says has moved must still be able to contradict
  // it.
  const bool followed =
      session.segment() && session.segment()->id == request.odom_segment && session.segment()->followed;
  auto spot =
      Spot::create(request, std::move(room), options, std::move(bounds), [&](const Cloud& cloud_sensor) {
        return followed ? std::vector<std::uint32_t>() : session.earlier_views.moving(request, cloud_sensor);
      });
  if (spot) session.earlier_views.add(request, (*spot)->query().view);
  return spot;
}

Answer answer_of(DeviceSession& session, const std::shared_ptr<const Spot>& spot, bool spare_time) {
  Answer answer{refusal(spot->request(), Reason::none, ""), {}};
  answer.reply.gpc_stamp_ns = spot->gpc_stamp_ns();
  answer.evidence = session.answer(spot, spare_time, &answer.reply);
  note_gravity(*spot, &answer.reply);
  if (!spot->trouble().empty()) answer.reply.text += "; " + spot->trouble();
  return answer;
}

Rerun run_again(const Answered& answered) {
  LocalizerOptions options = answered.options;
  options.search_limit = std::chrono::hours(1);
  const auto spot = Spot::create(answered.request, answered.room, options, answered.bounds,
                                 [&](const Cloud& /*cloud_sensor*/) { return answered.moving; });
  if (!spot) return {nullptr, {refusal(answered.request, Reason::bad_cloud, spot.error().message), {}}};
  DeviceSession session(options, answered.before);
  return {*spot, answer_of(session, *spot, answered.spare_time)};
}

}  // namespace liloc
