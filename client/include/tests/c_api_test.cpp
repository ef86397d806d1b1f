// Wrong use of the C API is a status with a remedy, never an abort.
#include <cmath>
#include <limits>

#include "client/include/tests/c_api_helpers.hpp"

namespace {

using namespace liloc::test;
using testing::HasSubstr;

TEST(CApi, DefaultsAreThoseOfTheLibrary) {
  const liloc_client_options o = good_options();
  EXPECT_STREQ(o.network_interface, "lo");
  EXPECT_EQ(o.interval_ms, 800);
  EXPECT_DOUBLE_EQ(o.voxel_size_m, 0.05);
  EXPECT_EQ(o.queue_frames, 4U);
  EXPECT_DOUBLE_EQ(o.T_imu_sensor.rotation_xyzw[3], 1);
  EXPECT_EQ(o.trace_folder, nullptr);
}

TEST(CApi, NullIsRefusedEverywhere) {
  const liloc_client_options o = good_options();
  const Handle client = created();
  const double three[3] = {0, 0, 0};
  liloc_pose_update update;
  liloc_stats stats;
  const std::vector<std::function<liloc_status()>> calls{
      [] { return liloc_client_options_init(nullptr, sizeof(liloc_client_options)); },
      [&] { return liloc_client_create(&o, sizeof o, nullptr); },
      [] { return liloc_client_on_pose(nullptr, nullptr, nullptr); },
      [] { return liloc_client_on_reply(nullptr, nullptr, nullptr); },
      [] { return liloc_client_start(nullptr); },
      [] { return push(nullptr, 1); },
      [&] { return liloc_client_push_depth(client.get(), nullptr, kWidth, kHeight, 1); },
      [&] { return liloc_client_push_imu(nullptr, 1, three, three); },
      [&] { return liloc_client_push_imu(client.get(), 1, nullptr, three); },
      [&] { return liloc_client_push_imu(client.get(), 1, three, nullptr); },
      [&] { return liloc_client_push_points(client.get(), nullptr, 1, 1); },
      [&] { return liloc_client_push_odometry(client.get(), 1, nullptr, three); },
      [&] { return liloc_client_newest(nullptr, &update, sizeof update); },
      [&] { return liloc_client_stats(nullptr, &stats, sizeof stats); },
      [] { return liloc_client_stop(nullptr); }};
  for (std::size_t i = 0; i < calls.size(); ++i) {
    EXPECT_EQ(calls[i](), LILOC_INVALID_ARGUMENT) << "call " << i;
    EXPECT_THAT(error(), HasSubstr("NULL")) << "call " << i;
  }
  EXPECT_EQ(liloc_client_destroy(nullptr), LILOC_OK);
}

TEST(CApi, WrongOptionsAreNamedAtCreate) {
  const char* const no_host[] = {nullptr};
  const std::vector<std::pair<std::function<void(liloc_client_options&)>, const char*>> cases{
      {[](auto& o) { o.id = nullptr; }, "options.id"},
      {[](auto& o) { o.network_interface = nullptr; }, "options.network_interface"},
      {[](auto& o) { o.domain = 231; }, "options.domain is 231"},
      {[](auto& o) { o.domain = -1; }, "options.domain is -1"},
      {[](auto& o) { o.local = 4; }, "options.local is 4"},
      {[](auto& o) { o.peer_count = 2; }, "options.peers is NULL"},
      {[&](auto& o) {
         o.peers = no_host;
         o.peer_count = 1;
       },
       "options.peers[0]"}};
  for (const auto& [spoil, text] : cases) {
    liloc_client_options o = good_options();
    spoil(o);
    liloc_client* client = reinterpret_cast<liloc_client*>(&o);
    EXPECT_EQ(liloc_client_create(&o, sizeof o, &client), LILOC_INVALID_ARGUMENT) << text;
    EXPECT_THAT(error(), HasSubstr(text));
    EXPECT_EQ(client, nullptr);
  }
}

TEST(CApi, WrongOptionsAreNamedAtStart) {
  const std::vector<std::pair<std::function<void(liloc_client_options&)>, const char*>> cases{
      {[](auto& o) { o.id = "no blanks please"; }, "options.id"},
      {[](auto& o) { o.camera.fx = 0; }, "options.camera.fx"},
      {[](auto& o) { o.camera.width = -3; }, "options.camera.width"},
      {[](auto& o) { o.voxel_size_m = std::numeric_limits<double>::quiet_NaN(); }, "options.voxel_size_m"},
      {[](auto& o) { o.local = LILOC_LOCAL_INERTIAL; }, "options.T_imu_sensor"},
      {[](auto& o) {
         o.has_imu = true;
         o.T_imu_sensor.rotation_xyzw[3] = 0;
       },
       "options.T_imu_sensor"}};
  for (const auto& [spoil, text] : cases) {
    liloc_client_options o = good_options();
    spoil(o);
    const Handle client = created(o);
    EXPECT_EQ(liloc_client_start(client.get()), LILOC_INVALID_ARGUMENT) << text;
    EXPECT_THAT(error(), HasSubstr(text));
  }
}

TEST(CApi, TheNetworksErrorIsNotTheCallers) {
  liloc_client_options o = good_options();
  o.network_interface = "nosuchcard0";
  const Handle client = created(o);
  EXPECT_EQ(liloc_client_start(client.get()), LILOC_FAILED);
  EXPECT_THAT(error(), HasSubstr("nosuchcard0"));
}

TEST(CApi, StructuresGrowWithoutBreakingPrograms) {
  struct Newer {  // of a header that came after this library
    liloc_client_options options;
    std::int64_t later;
  } newer{};
  ASSERT_EQ(liloc_client_options_init(&newer.options, sizeof newer), LILOC_OK);
  EXPECT_EQ(newer.later, 0);
  newer.options.id = "newer";
  liloc_client* client = nullptr;
  EXPECT_EQ(liloc_client_create(&newer.options, sizeof newer, &client), LILOC_OK) << error();
  EXPECT_EQ(liloc_client_destroy(client), LILOC_OK);
  newer.later = 1;
  EXPECT_EQ(liloc_client_create(&newer.options, sizeof newer, &client), LILOC_INVALID_ARGUMENT);
  EXPECT_THAT(error(), HasSubstr("does not know"));

  for (const std::size_t size : {std::size_t{0}, std::size_t{8}, std::numeric_limits<std::size_t>::max()}) {
    EXPECT_EQ(liloc_client_options_init(&newer.options, size), LILOC_INVALID_ARGUMENT) << size;
    EXPECT_EQ(liloc_client_create(&newer.options, size, &client), LILOC_INVALID_ARGUMENT) << size;
    EXPECT_THAT(error(), HasSubstr("sizeof(liloc_client_options)"));
  }
}

TEST(CApi, TheOrderOfCallsIsHeld) {
  const Handle client = created();
  liloc_pose_update update;
  liloc_stats stats;
  EXPECT_EQ(push(client.get(), 1), LILOC_WRONG_STATE);
  EXPECT_THAT(error(), HasSubstr("liloc_client_start"));
  EXPECT_EQ(liloc_client_newest(client.get(), &update, sizeof update), LILOC_WRONG_STATE);
  EXPECT_EQ(liloc_client_stats(client.get(), &stats, sizeof stats), LILOC_WRONG_STATE);

  ASSERT_EQ(liloc_client_start(client.get()), LILOC_OK) << error();
  EXPECT_EQ(liloc_client_start(client.get()), LILOC_WRONG_STATE);
  EXPECT_THAT(error(), HasSubstr("already started"));
  EXPECT_EQ(liloc_client_on_pose(client.get(), nullptr, nullptr), LILOC_WRONG_STATE);
  ASSERT_EQ(liloc_client_newest(client.get(), &update, sizeof update), LILOC_OK);
  EXPECT_EQ(update.stamp_ns, 0);
  EXPECT_FALSE(update.has_map);

  EXPECT_EQ(liloc_client_stop(client.get()), LILOC_OK);
  EXPECT_EQ(liloc_client_stop(client.get()), LILOC_OK);
  EXPECT_EQ(push(client.get(), 2), LILOC_WRONG_STATE);
  EXPECT_THAT(error(), HasSubstr("create another client"));
  EXPECT_EQ(liloc_client_start(client.get()), LILOC_WRONG_STATE);
  EXPECT_EQ(liloc_client_stats(client.get(), &stats, sizeof stats), LILOC_OK);
}

TEST(CApi, WrongSamplesAreRefused) {
  liloc_client_options o = good_options();
  const Handle without_imu = created(o);
  o.id = "c-api-imu";
  o.has_imu = true;
  const Handle client = created(o);
  ASSERT_EQ(liloc_client_start(client.get()), LILOC_OK) << error();
  ASSERT_EQ(liloc_client_start(without_imu.get()), LILOC_OK) << error();
  const std::vector<std::uint16_t> image(kWidth * kHeight);
  EXPECT_EQ(liloc_client_push_depth(client.get(), image.data(), kHeight, kWidth, 1), LILOC_INVALID_ARGUMENT);
  EXPECT_THAT(error(), HasSubstr("24x32"));
  const double fine[3] = {0, 0, 9.81}, broken[3] = {0, std::nan(""), 0};
  EXPECT_EQ(liloc_client_push_imu(client.get(), 1, fine, fine), LILOC_OK) << error();
  EXPECT_EQ(liloc_client_push_imu(client.get(), 1, fine, broken), LILOC_INVALID_ARGUMENT);
  EXPECT_THAT(error(), HasSubstr("finite"));
  EXPECT_EQ(liloc_client_push_imu(without_imu.get(), 1, fine, fine), LILOC_INVALID_ARGUMENT);
  EXPECT_THAT(error(), HasSubstr("has_imu"));
  liloc_pose_update update;
  EXPECT_EQ(liloc_client_newest(client.get(), &update, 4), LILOC_INVALID_ARGUMENT);
  EXPECT_EQ(liloc_client_newest(client.get(), nullptr, sizeof update), LILOC_INVALID_ARGUMENT);
}

TEST(CApi, ErrorsBelongToTheirThread) {
  EXPECT_EQ(liloc_client_stop(nullptr), LILOC_INVALID_ARGUMENT);
  std::string other = "not run";
  std::thread([&] { other = error(); }).join();
  EXPECT_EQ(other, "");
  EXPECT_NE(error(), "");
}

TEST(CApi, StatusesHaveNames) {
  EXPECT_STREQ(liloc_client_status_name(LILOC_OK), "LILOC_OK");
  EXPECT_STREQ(liloc_client_status_name(LILOC_INTERNAL), "LILOC_INTERNAL");
  EXPECT_STREQ(liloc_client_status_name(6), "unknown status");
  EXPECT_STREQ(liloc_client_status_name(-1), "unknown status");
}

}  // namespace
