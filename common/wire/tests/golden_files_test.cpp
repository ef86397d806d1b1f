// Messages as bytes in files, one folder a protocol version. Those of version 1 were made from those of version
// 2: the request with another number, the reply without its last two fields. LILOC_RENEW_GOLDEN=1 writes those
// of the present version anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/wire/dds/cdr.hpp"
#include "common/wire/spots/convert_spot.hpp"
#include "common/wire/spots/convert_status.hpp"
#include "common/wire/spots/tests/samples.hpp"

namespace liloc::wire {
namespace {

using Bytes = std::vector<unsigned char>;
constexpr std::uint64_t kSession = 0x1122334455667788;

std::filesystem::path file_of(int version, const char* name) {
  return std::filesystem::path("common/wire/tests/golden") / fmt::format("v{}", version) / name;
}

Bytes read(int version, const char* name) {
  std::ifstream file(file_of(version, name), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What the file holds; writes `bytes` into it first where asked.
Bytes kept(const char* name, const Bytes& bytes) {
  if (std::getenv("LILOC_RENEW_GOLDEN") != nullptr) {
    std::filesystem::create_directories(file_of(kProtocolVersion, name).parent_path());
    std::ofstream(file_of(kProtocolVersion, name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  return read(kProtocolVersion, name);
}

class GoldenFiles : public testing::Test {
 protected:
  const SpotRequest request = sample_request();
  const Participant seat = Participant::create({.domain = 114}).value();
  const RequestSample sample = to_wire(request, kSession).value();
  const Cdr<liloc_msg_SpotRequest> requests = Cdr<liloc_msg_SpotRequest>::create(seat, sample.message).value();
  const Cdr<liloc_msg_SpotReply> replies =
      Cdr<liloc_msg_SpotReply>::create(seat, to_wire(sample_reply(), kSession)).value();
};

TEST_F(GoldenFiles, ThePresentVersionsRequestIsDecodedToWhatWasAsked) {
  const Bytes bytes = kept("spot_request.cdr", requests.encode(sample.message));
  ASSERT_EQ(bytes, requests.encode(sample.message)) << "changed bytes: raise the version, LILOC_RENEW_GOLDEN=1";
  const auto message = requests.decode(bytes);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->protocol_version, kProtocolVersion);
  EXPECT_EQ(message->session, kSession);
  const auto decoded = from_wire(*message);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->client_id, "robot1");
  EXPECT_EQ(decoded->stamp_ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(decoded->local_poses.size(), 2U);
  EXPECT_EQ(decoded->lpc.bytes, request.lpc.bytes);
  EXPECT_EQ(decoded->extra.bytes, request.extra.bytes);
  EXPECT_TRUE(decoded->T_odom_sensor.isApprox(request.T_odom_sensor));
}

TEST_F(GoldenFiles, ThePresentVersionsReplyIsDecodedToWhatWasAnswered) {
  const auto reply = to_wire(sample_reply(), kSession);
  const Bytes bytes = kept("spot_reply.cdr", replies.encode(reply));
  ASSERT_EQ(bytes, replies.encode(reply)) << "changed bytes: raise the version, LILOC_RENEW_GOLDEN=1";
  const auto message = replies.decode(bytes);
  ASSERT_TRUE(message);
  const auto decoded = from_wire(*message);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->reason, Reason::confirmed);
  EXPECT_EQ(decoded->confidence, 0.75);
  EXPECT_EQ(decoded->advice, Advice::twin);
  ASSERT_TRUE(decoded->T_map_odom);
  EXPECT_TRUE(decoded->T_map_odom->isApprox(*sample_reply().T_map_odom));
}

TEST_F(GoldenFiles, ThePresentVersionsStatusIsDecodedToWhatWasTold) {
  const ServerStatus status = sample_status();
  const auto told = to_wire(status);
  const auto statuses = Cdr<liloc_msg_ServerStatus>::create(seat, told.message).value();
  const Bytes bytes = kept("server_status.cdr", statuses.encode(told.message));
  ASSERT_EQ(bytes, statuses.encode(told.message)) << "changed bytes: raise the version, LILOC_RENEW_GOLDEN=1";
  const auto message = statuses.decode(bytes);
  ASSERT_TRUE(message);
  const auto decoded = from_wire(*message);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->server_id, "edge1");
  ASSERT_EQ(decoded->lidars.size(), 1U);
  EXPECT_EQ(decoded->lidars[0].state, LidarState::slow);
  EXPECT_EQ(decoded->lidars[0].usual_range_m, 4);
  EXPECT_TRUE(decoded->lidars[0].clock_corrected);
  EXPECT_EQ(decoded->refused, 10U);
  EXPECT_EQ(decoded->codecs, status.codecs);
}

// Requests of version 1 have the layout of version 2: a newer server reads whose they are, and refuses by
// version.
TEST_F(GoldenFiles, AnOlderClientsRequestTellsItsVersion) {
  const auto message = requests.decode(read(1, "spot_request.cdr"));
  ASSERT_TRUE(message);
  EXPECT_EQ(message->protocol_version, 1);
  EXPECT_EQ(message->seq, request.seq);
}

// Replies of version 1 are shorter: no newer client mistakes one for its own.
TEST_F(GoldenFiles, AnOlderServersReplyIsRefusedAsAWhole) {
  const Bytes bytes = read(1, "spot_reply.cdr");
  ASSERT_FALSE(bytes.empty());
  EXPECT_EQ(replies.decode(bytes), nullptr);
}

TEST_F(GoldenFiles, CutShortNothingIsDecoded) {
  const Bytes whole = read(kProtocolVersion, "spot_request.cdr");
  for (std::size_t size = 0; size + 8 < whole.size(); ++size)
    EXPECT_EQ(requests.decode({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}), nullptr)
        << size;
}

}  // namespace
}  // namespace liloc::wire
