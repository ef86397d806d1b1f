#include "common/wire/spots/convert_status.hpp"

#include "common/base/ids.hpp"
#include "common/protocol/spot.hpp"
#include "common/wire/dds/convert.hpp"

namespace liloc::wire {

std::string_view name_of(LidarState state) {
  switch (state) {
    case LidarState::waiting:
      return "waiting";
    case LidarState::ok:
      return "ok";
    case LidarState::slow:
      return "slow";
    case LidarState::silent:
      return "silent";
    case LidarState::malformed:
      return "malformed";
    case LidarState::blind:
      return "blind";
    case LidarState::implausible:
      return "implausible";
    case LidarState::clock_off:
      return "clock_off";
  }
  return "unknown";
}

StatusSample to_wire(const ServerStatus& status) {
  constexpr std::size_t kMaxLidars = 64;  // as idl/liloc.idl has it
  StatusSample sample;
  auto& m = sample.message;
  m.protocol_version = kProtocolVersion;
  copy_text(m.server_id, status.server_id);
  m.stamp_ns = status.stamp_ns;
  m.uptime_s = status.uptime_s;
  for (const auto& lidar : status.lidars) {
    if (sample.lidars.size() == kMaxLidars) break;
    auto& row = sample.lidars.emplace_back();
    copy_text(row.id, lidar.id);
    row.state = static_cast<std::uint8_t>(lidar.state);
    row.measured_hz = lidar.measured_hz;
    row.frames = lidar.frames;
    row.malformed = lidar.malformed;
    copy_text(row.last_error, lidar.last_error);
    row.returns = lidar.returns;
    row.range_m = lidar.range_m;
    row.usual_range_m = lidar.usual_range_m;
    row.clock_offset_s = lidar.clock_offset_s;
    row.clock_corrected = lidar.clock_corrected;
  }
  lend(m.lidars, sample.lidars);
  m.clients = status.clients;
  m.queued = status.queued;
  m.answered = status.answered;
  m.verified = status.verified;
  m.refused = status.refused;
  for (const CloudCodec codec : status.codecs) sample.codecs.push_back(static_cast<std::uint8_t>(codec));
  lend(m.codecs, sample.codecs);
  return sample;
}

namespace {

constexpr double kMostOffset_s = 1e11;  // stamps are 64 bits of nanoseconds: 292 years

Result<LidarHealth> from_wire(const liloc_msg_LidarHealth& row, const std::string& where) {
  for (const Status& valid :
       {finite(row.measured_hz, where + ".measured_hz", 0, 1e6), finite(row.returns, where + ".returns", 0, 1),
        finite(row.range_m, where + ".range_m", 0, 1e6),
        finite(row.usual_range_m, where + ".usual_range_m", 0, 1e6),
        finite(row.clock_offset_s, where + ".clock_offset_s", -kMostOffset_s, kMostOffset_s)})
    if (!valid) return tl::unexpected(valid.error());
  return LidarHealth{text_of(row.id),    static_cast<LidarState>(row.state),  // a newer server may know more
                     row.measured_hz,    row.frames,
                     row.malformed,      text_of(row.last_error),
                     row.returns,        row.range_m,
                     row.usual_range_m,  row.clock_offset_s,
                     row.clock_corrected};
}

}  // namespace

Result<ServerStatus> from_wire(const liloc_msg_ServerStatus& message) {
  if (message.protocol_version != kProtocolVersion)
    return fail("server speaks version {}, this program {}; update the older one", message.protocol_version,
                kProtocolVersion);
  ServerStatus status;
  const auto id = valid_id(text_of(message.server_id), "server_id");
  if (!id) return tl::unexpected(id.error());
  status.server_id = *id;
  status.stamp_ns = message.stamp_ns;
  status.uptime_s = message.uptime_s;
  if (auto valid = finite(message.uptime_s, "uptime_s", 0, 1e12); !valid) return tl::unexpected(valid.error());
  for (std::uint32_t i = 0; i < message.lidars._length; ++i) {
    auto lidar = from_wire(message.lidars._buffer[i], fmt::format("lidars[{}]", i));
    if (!lidar) return tl::unexpected(lidar.error());
    status.lidars.push_back(std::move(*lidar));
  }
  status.clients = message.clients;
  status.queued = message.queued;
  status.answered = message.answered;
  status.verified = message.verified;
  status.refused = message.refused;
  for (std::uint32_t i = 0; i < message.codecs._length; ++i)  // some may be newer than this program
    status.codecs.push_back(static_cast<CloudCodec>(message.codecs._buffer[i]));
  return status;
}

}  // namespace liloc::wire
