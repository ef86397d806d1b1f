#include "common/wire/sensors/sensor_publishers.hpp"

#include <gtest/gtest.h>

#include <mutex>
#include <optional>
#include <thread>

#include "common/wire/sensors/sensors.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;
constexpr int kDomain = 121;  // of this test alone
constexpr Camera kCamera{4, 3, 5, 5, 2, 1.5, 0.001};

DepthImage image_of(int width, int height) {
  DepthImage image{1'000'000'007, width, height, {}};
  image.units.assign(static_cast<std::size_t>(width * height), 1500);
  return image;
}

TEST(DepthPublisher, AnImageAndItsCameraInfoCarryOneStamp) {
  const auto seat = Participant::create({.domain = kDomain}).value();
  const auto dispatcher = Dispatcher::create(seat).value();
  std::mutex mutex;
  std::optional<DepthImage> image;
  std::optional<Camera> camera;
  ASSERT_TRUE(subscribe_depth(*dispatcher, "ceiling0", 0.001, [&](const Result<DepthImage>& heard) {
    const std::scoped_lock lock(mutex);
    if (heard) image = *heard;
  }));
  ASSERT_TRUE(subscribe_camera_info(*dispatcher, "ceiling0", [&](const Result<Camera>& heard) {
    const std::scoped_lock lock(mutex);
    if (heard) camera = *heard;
  }));
  dispatcher->start();
  const auto publisher = DepthPublisher::create(seat, "ceiling0", kCamera).value();
  for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(10ms)) {
    ASSERT_TRUE(publisher.publish(image_of(4, 3)));
    const std::scoped_lock lock(mutex);
    if (image && camera) break;
  }
  EXPECT_EQ(publisher.readers(), 1);
  dispatcher->stop();
  ASSERT_TRUE(image && camera);
  EXPECT_EQ(image->stamp_ns, 1'000'000'007);
  EXPECT_EQ(image->units, image_of(4, 3).units);
  EXPECT_EQ(camera->width, kCamera.width);
  EXPECT_DOUBLE_EQ(camera->fx, kCamera.fx);
}

TEST(DepthPublisher, AnImageThatIsNotTheCamerasIsRefused) {
  const auto seat = Participant::create({.domain = kDomain}).value();
  const auto publisher = DepthPublisher::create(seat, "ceiling0", kCamera).value();
  const auto sent = publisher.publish(image_of(3, 4));
  ASSERT_FALSE(sent);
  EXPECT_NE(sent.error().message.find("3 x 4"), std::string::npos) << sent.error().message;
  DepthImage cut = image_of(4, 3);
  cut.units.pop_back();
  EXPECT_FALSE(publisher.publish(cut));
}

TEST(SensorPublishers, ABadIdOrCameraIsRefused) {
  const auto seat = Participant::create({.domain = kDomain}).value();
  EXPECT_FALSE(DepthPublisher::create(seat, "a/b", kCamera));
  EXPECT_FALSE(DepthPublisher::create(seat, "ceiling0", {0, 3, 5, 5, 2, 1.5, 0.001}));
  EXPECT_FALSE(PointsPublisher::create(seat, ""));
  EXPECT_FALSE(ImuPublisher::create(seat, "no name"));
}

}  // namespace
}  // namespace liloc::wire
