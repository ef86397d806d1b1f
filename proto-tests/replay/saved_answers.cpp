#include "proto-tests/replay/saved_answers.hpp"

namespace liloc::replay {

Status SavedAnswers::open(const std::string& where, const Recording& recording) {
  if (where.empty()) return {};
  const auto options = answers::store_options_from(where);
  if (!options) return fail("--{}", options.error().message);
  auto store = answers::AnswerStore::open(*options);
  if (!store) return fail("--{}", store.error().message);
  store_ = std::move(*store);
  if (options->which != answers::Which::wrong) return {};
  for (const DeviceRecording& device : recording.devices) {
    auto truth = Truth::of(device);
    if (!truth) return tl::unexpected(truth.error());
    truth_.emplace(device.info.id, std::move(*truth));
  }
  return {};
}

bool SavedAnswers::wanted(const Answered& answered) const {
  const SpotReply& reply = answered.reply;
  if (store_->options().which == answers::Which::all) return true;
  if (store_->options().which == answers::Which::refused) return !reply.verified();
  if (!reply.verified()) return false;
  const Truth& truth = truth_.at(reply.client_id);
  const auto frame = truth.frame_near(reply.stamp_ns);
  if (frame < 0) return false;
  const Pose& T_map_sensor = truth.pose(static_cast<std::size_t>(frame));
  return distance_m(T_map_sensor, *reply.T_map_sensor) > 0.3 ||
         degrees(angle_between_rad(T_map_sensor, *reply.T_map_sensor)) > 10;
}

void SavedAnswers::take(const Answered& answered) {
  if (!status_ || !wanted(answered)) return;
  status_ = store_->save(answered);
}

}  // namespace liloc::replay
