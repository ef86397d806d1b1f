#include "common/protocol/spot.hpp"

#include <algorithm>
#include <utility>

namespace liloc {

std::string_view name_of(CloudCodec codec) {
  switch (codec) {
    case CloudCodec::draco:
      return "draco";
    case CloudCodec::octree:
      return "octree";
    case CloudCodec::voxel:
      return "voxel";
  }
  return "unknown";
}

std::optional<CloudCodec> codec_from(std::string_view name) {
  const auto* found = std::ranges::find(kCloudCodecs, name, [](CloudCodec codec) { return name_of(codec); });
  return found == kCloudCodecs.end() ? std::nullopt : std::optional(*found);
}

std::string_view name_of(SpotStatus status) {
  switch (status) {
    case SpotStatus::verified:
      return "verified";
    case SpotStatus::provisional:
      return "provisional";
    case SpotStatus::refused:
      return "refused";
  }
  return "unknown";
}

std::string_view name_of(Reason reason) {
  switch (reason) {
    case Reason::none:
      return "none";
    case Reason::confirmed:
      return "confirmed";
    case Reason::conclusive:
      return "conclusive";
    case Reason::corrected:
      return "corrected";
    case Reason::awaiting_spots:
      return "awaiting_spots";
    case Reason::ambiguous:
      return "ambiguous";
    case Reason::inconsistent:
      return "inconsistent";
    case Reason::weak:
      return "weak";
    case Reason::no_gpc:
      return "no_gpc";
    case Reason::not_found:
      return "not_found";
    case Reason::superseded:
      return "superseded";
    case Reason::overloaded:
      return "overloaded";
    case Reason::late:
      return "late";
    case Reason::bad_request:
      return "bad_request";
    case Reason::bad_cloud:
      return "bad_cloud";
    case Reason::protocol_version:
      return "protocol_version";
    case Reason::identity:
      return "identity";
    case Reason::rate_limit:
      return "rate_limit";
    case Reason::shutting_down:
      return "shutting_down";
    case Reason::no_answer:
      return "no_answer";
  }
  return "unknown";
}

std::string_view name_of(Advice advice) {
  switch (advice) {
    case Advice::none:
      return "none";
    case Advice::wait:
      return "wait";
    case Advice::turn_around:
      return "turn_around";
    case Advice::move_on:
      return "move_on";
    case Advice::more_coverage:
      return "more_coverage";
    case Advice::twin:
      return "twin";
    case Advice::clear_view:
      return "clear_view";
  }
  return "unknown";
}

SpotReply refusal(const SpotRequest& request, Reason reason, std::string text) {
  SpotReply reply;
  reply.client_id = request.client_id;
  reply.seq = request.seq;
  reply.stamp_ns = request.stamp_ns;
  reply.odom_segment = request.odom_segment;
  reply.request_sent_ns = request.sent_ns;
  reply.status = SpotStatus::refused;
  reply.reason = reason;
  reply.text = std::move(text);
  return reply;
}

}  // namespace liloc
