#include "proto-tests/inputs/stranger.hpp"

#include <algorithm>

#include "common/wire/dds/convert.hpp"
#include "common/wire/dds/topics.hpp"
#include "common/wire/spots/convert_spot.hpp"

namespace liloc::inputs {
namespace {

// Clears a terminal, rings, forges a line of a log and of a shell, and an 8-bit CSI.
constexpr char kForged[] =
    "x\x1b[2J\x07\r\n2026-01-01 00:00:00.000 info FORGED\n\xc2\x9b"
    "31m";
constexpr std::uint64_t kNobodysSession = 99;

SpotRequest request_of(const std::string& id, std::uint64_t seq) {
  SpotRequest request;
  request.client_id = id;
  request.seq = seq;
  request.stamp_ns = wall_clock_ns();
  request.lpc = {CloudCodec::draco, {1, 2, 3}};
  request.view.camera = {160, 120, 115, 115, 79.5, 59.5, 0.001};
  return request;
}

}  // namespace

Result<std::unique_ptr<Stranger>> Stranger::join(int domain, const std::string& victim,
                                                 const std::string& lidar) {
  auto seat = wire::Participant::create({.domain = domain});
  if (!seat) return tl::unexpected(seat.error());
  std::unique_ptr<Stranger> stranger(new Stranger(*seat, victim));
  const auto keep = [](auto& list, auto writer) -> Status {
    if (!writer) return tl::unexpected(writer.error());
    list.push_back(std::move(*writer));
    return {};
  };
  const std::string own = wire::client_partition(victim);
  for (const std::vector<std::string>& partitions :
       {std::vector<std::string>{own}, {"robots/mallory", own}, {"robots/*"}, {"robots/mallory"}}) {
    if (Status made = keep(stranger->requests_,
                           ForgedWriter<liloc_msg_SpotRequest>::create(*seat, wire::kRequestTopic, partitions));
        !made)
      return tl::unexpected(made.error());
    if (Status made = keep(stranger->replies_,
                           ForgedWriter<liloc_msg_SpotReply>::create(*seat, wire::kReplyTopic, partitions));
        !made)
      return tl::unexpected(made.error());
  }
  if (Status made = keep(stranger->statuses_, ForgedWriter<liloc_msg_ServerStatus>::create(
                                                  *seat, wire::kStatusTopic, {wire::kStatusPartition}));
      !made)
    return tl::unexpected(made.error());
  for (const std::string& id : {lidar, victim})
    if (Status made = keep(stranger->images_,
                           wire::make_writer<sensor_msgs_msg_dds__Image_>(
                               seat->handle(), seat->handle(), wire::depth_topic(id), wire::reliable_qos(8)));
        !made)
      return tl::unexpected(made.error());
  return stranger;
}

void Stranger::molest() {
  ++rounds_;
  forge_requests();
  forge_replies();
  forge_status();
  forge_images();
  const std::string name = "s" + std::to_string(rounds_);  // is here, and has left
  const auto passer =
      ForgedWriter<liloc_msg_SpotRequest>::create(seat_, wire::kRequestTopic, {wire::client_partition(name)});
  const auto outside = ForgedWriter<liloc_msg_SpotRequest>::create(seat_, wire::kRequestTopic,
                                                                   {"robots/" + std::string(kForged)});
  const SpotRequest request = request_of(name, 1);
  if (passer)
    if (auto sample = wire::to_wire(request, kNobodysSession)) passer->write(sample->message);
}

void Stranger::forge_requests() {
  const SpotRequest request = request_of(victim_, static_cast<std::uint64_t>(rounds_));
  auto sample = wire::to_wire(request, kNobodysSession);
  if (!sample) return;
  for (const auto& writer : requests_) writer.write(sample->message);
  wire::copy_text(sample->message.client_id, kForged);
  for (const auto& writer : requests_) writer.write(sample->message);
  sample->message.protocol_version = 77;
  for (const auto& writer : requests_) writer.write(sample->message);
}

void Stranger::forge_replies() {
  SpotReply reply = refusal(request_of(victim_, static_cast<std::uint64_t>(rounds_)), Reason::none, kForged);
  reply.server_id = "edge";
  auto message = wire::to_wire(reply, kNobodysSession);
  for (const auto& writer : replies_) writer.write(message);
  wire::copy_text(message.server_id, kForged);
  for (const auto& writer : replies_) writer.write(message);
  message.status = 200;
  message.covariance[3] = -1e300;
  for (const auto& writer : replies_) writer.write(message);
}

void Stranger::forge_status() {
  liloc_msg_ServerStatus message{};
  message.protocol_version = kProtocolVersion;
  wire::copy_text(message.server_id, kForged);
  for (const auto& writer : statuses_) writer.write(message);
  wire::copy_text(message.server_id, ("edge" + std::to_string(rounds_)).c_str());
  const std::vector<std::uint8_t> codecs{1};  // and none that the victim uses
  wire::lend(message.codecs, codecs);
  for (const auto& writer : statuses_) writer.write(message);
}

void Stranger::forge_images() {
  sensor_msgs_msg_dds__Image_ image{};
  image.header.stamp.sec = rounds_;
  image.width = 4;
  image.height = 1;
  image.step = 8;
  wire::copy_text(image.encoding, kForged);
  std::vector<std::uint8_t> data(8);
  wire::lend(image.data, data);
  for (const auto& writer : images_) static_cast<void>(dds_write(writer.handle(), &image));
}

}  // namespace liloc::inputs
