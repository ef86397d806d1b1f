#include "proto-tests/sim/sensors/sensor_models.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "proto-tests/sim/sensors/sensor_field.hpp"

namespace liloc::sim {
namespace {

using testing::AllOf;
using testing::Ge;
using testing::Le;

constexpr int kWidth = 160, kHeight = 120, kFrames = 20;
const Camera kCamera{kWidth, kHeight, 228, 228, 0.5 * (kWidth - 1), 0.5 * (kHeight - 1), 0.00025};

using Depth = std::function<float(int u, int v)>;

View view_of(const Depth& depth, float cosine, Material material) {
  View view;
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) view.depth_m.push_back(depth(u, v));
  view.cos_incidence.assign(view.depth_m.size(), cosine);
  view.material.assign(view.depth_m.size(), material);
  return view;
}

View wall(float depth_m, float cosine = 1, Material material = Material::matte) {
  return view_of([=](int, int) { return depth_m; }, cosine, material);
}

/// What a sensor makes of a wall, in the middle of the image over many frames.
struct Seen {
  double share = 0, spread_m = 0, bias_m = 0;
};
Seen seen(SensorModel model, const View& view, int half = 20) {
  const DepthSensor sensor{kCamera, 0.2, 9, 1, model};
  double count = 0, sum = 0, square = 0, all = 0;
  for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
    const DepthImage image = sense(view, sensor, 100 + frame, 0);
    for (int v = kHeight / 2 - half; v < kHeight / 2 + half; ++v)
      for (int u = kWidth / 2 - half; u < kWidth / 2 + half; ++u) {
        ++all;
        const auto pixel = static_cast<std::size_t>(v * kWidth + u);
        if (image.units[pixel] == 0) continue;
        const double off = image.units[pixel] * kCamera.depth_scale_m - view.depth_m[pixel];
        ++count;
        sum += off;
        square += off * off;
      }
  }
  const double mean = sum / std::max(1.0, count);
  return {count / all, std::sqrt(std::max(0.0, square / std::max(1.0, count) - mean * mean)), mean};
}

class EverySensor : public testing::TestWithParam<SensorModel> {};

TEST_P(EverySensor, SeesExactlyWithoutNoise) {
  const DepthImage image = sense(wall(3), {kCamera, 0.2, 9, 0, GetParam()}, 1, 0);
  EXPECT_EQ(image.at(kWidth / 2, kHeight / 2), 12000);
}
TEST_P(EverySensor, FollowsFromItsKey) {
  const DepthSensor sensor{kCamera, 0.2, 9, 1, GetParam()};
  EXPECT_EQ(sense(wall(3), sensor, 5, 0).units, sense(wall(3), sensor, 5, 0).units);
  EXPECT_NE(sense(wall(3), sensor, 5, 0).units, sense(wall(3), sensor, 6, 0).units);
}
TEST_P(EverySensor, SeesLessFarAwayAndAtAGrazingAngle) {
  const Seen near = seen(GetParam(), wall(2)), far = seen(GetParam(), wall(5.2F));
  const Seen grazing = seen(GetParam(), wall(3, 0.05F));
  EXPECT_LE(far.share, near.share);
  EXPECT_LT(grazing.share, 0.8 * near.share);
  EXPECT_GT(far.spread_m, near.spread_m);
}
INSTANTIATE_TEST_SUITE_P(Models, EverySensor,
                         testing::Values(SensorModel::l515, SensorModel::l515_real, SensorModel::kinect,
                                         SensorModel::tof));

// What SENSORS.md has of recordings/lab-l515, in the middle of the image.
TEST(L515Real, SeesAsManyPixelsAsTheTwoOfTheLab) {
  EXPECT_THAT(seen(SensorModel::l515_real, wall(3, 0.98F)).share, AllOf(Ge(0.90), Le(1.0)));     // there 0.99
  EXPECT_THAT(seen(SensorModel::l515_real, wall(4.4F, 0.99F)).share, AllOf(Ge(0.72), Le(0.9)));  // there 0.80
  EXPECT_THAT(seen(SensorModel::l515_real, wall(5.8F, 0.88F)).share, AllOf(Ge(0.35), Le(0.6)));  // there 0.44
  EXPECT_LT(seen(SensorModel::l515_real, wall(3, 0.4F, Material::carpet)).share, 0.1);
}
TEST(L515Real, IsAsNoisyAsTheTwoOfTheLab) {
  EXPECT_NEAR(seen(SensorModel::l515_real, wall(2.9F, 0.98F)).spread_m, 0.0065, 0.002);
  EXPECT_NEAR(seen(SensorModel::l515_real, wall(4.4F, 0.99F)).spread_m, 0.0104, 0.002);
  EXPECT_NEAR(seen(SensorModel::l515_real, wall(5.8F, 0.88F)).spread_m, 0.0158, 0.004);
}
TEST(L515Real, LosesInSpeckles) {
  const View view = wall(5);
  const DepthImage image = sense(view, {kCamera, 0.2, 9, 1, SensorModel::l515_real}, 3, 0);
  double lost = 0, both = 0, all = 0;
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u + 1 < kWidth; ++u) {
      const bool here = image.at(u, v) == 0, beside = image.at(u + 1, v) == 0;
      all += 1;
      lost += here;
      both += here && beside;
    }
  EXPECT_GT(both / lost, lost / all + 0.15) << "a lost pixel's neighbour is lost more often than others";
}

TEST(Kinect, ErrsWithTheSquareOfTheRange) {
  for (const float z : {1.5F, 2.5F, 4.0F, 5.0F})
    EXPECT_NEAR(seen(SensorModel::kinect, wall(z)).spread_m, 1.9e-3 * z * z, 0.35e-3 * z * z) << z;
}
TEST(Kinect, TellsWholeSteps) {
  const DepthImage image = sense(wall(4), {kCamera, 0.2, 9, 1, SensorModel::kinect}, 3, 0);
  std::vector<std::uint16_t> depths = image.units;
  std::ranges::sort(depths);
  depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
  EXPECT_LT(depths.size(), 12U);
  for (std::size_t i = 2; i < depths.size(); ++i) {
    const double between_m = (depths[i] - depths[i - 1]) * kCamera.depth_scale_m;
    const double z = depths[i] * kCamera.depth_scale_m;
    EXPECT_NEAR(between_m, 2.85e-3 * z * z, 0.3e-3 * z * z);
  }
}
TEST(Kinect, HasAShadowLeftOfWhatIsNear) {
  const View view = view_of([](int u, int) { return u >= 60 && u < 100 ? 1.5F : 4.0F; }, 1, Material::matte);
  const DepthImage image = sense(view, {kCamera, 0.2, 9, 1, SensorModel::kinect}, 3, 0);
  const auto lost = [&](int from, int to) {
    int count = 0;
    for (int v = 0; v < kHeight; ++v)
      for (int u = from; u < to; ++u) count += image.at(u, v) == 0;
    return count / static_cast<double>(kHeight * (to - from));
  };
  EXPECT_GT(lost(54, 59), 0.9);  // 228 px/rad * 0.075 m * (1/1.5 - 1/4) = 7 pixels wide
  EXPECT_LT(lost(20, 50), 0.05);
  EXPECT_LT(lost(103, 140), 0.05);
}

TEST(Tof, IsPreciseOnWallsAndLosesWhatIsDark) {
  EXPECT_LT(seen(SensorModel::tof, wall(3)).spread_m, 0.004);
  EXPECT_GT(seen(SensorModel::tof, wall(3)).share, 0.98);
  EXPECT_LT(seen(SensorModel::tof, wall(4, 1, Material::dark)).share, 0.2);
  EXPECT_EQ(seen(SensorModel::tof, wall(5.6F)).share, 0) << "the data sheet's range";
}
TEST(Tof, BulgesInConcaveCornersOnly) {
  const auto corner = [](float sign) {  // two walls at a right angle, its edge straight ahead at 3 m
    return view_of(
        [sign](int u, int) {
          const float x = static_cast<float>((u - kCamera.cx) / kCamera.fx);
          return 3 / (1 + sign * std::abs(x));
        },
        0.7F, Material::matte);
  };
  const Seen concave = seen(SensorModel::tof, corner(1), 5), convex = seen(SensorModel::tof, corner(-1), 5);
  EXPECT_THAT(concave.bias_m, AllOf(Ge(0.008), Le(0.03)));
  EXPECT_NEAR(convex.bias_m, 0, 0.002);
}
TEST(Tof, HasFlyingPixelsAndNoCorners) {
  const View view = view_of([](int u, int) { return u < 80 ? 1.5F : 4.0F; }, 1, Material::matte);
  int between = 0, corner = 0;
  for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
    const DepthImage image = sense(view, {kCamera, 0.2, 9, 1, SensorModel::tof}, frame, 0);
    for (int v = 0; v < kHeight; ++v) between += image.at(79, v) > 6400 && image.at(79, v) < 15600;
    corner += image.at(2, 2) != 0 || image.at(kWidth - 3, kHeight - 3) != 0;
  }
  EXPECT_NEAR(between / static_cast<double>(kFrames * kHeight), 0.15, 0.05);  // 0.3 of half the draws
  EXPECT_EQ(corner, 0);
}

TEST(SensorField, IsNormalAndAlikeNearby) {
  const SensorField field(9, 2);
  double square = 0, beside = 0, apart = 0;
  int within = 0;
  for (int v = 0; v < 200; ++v)
    for (int u = 0; u < 200; ++u) {
      const double here = field.at(u, v);
      square += here * here;
      beside += here * field.at(u + 1, v);
      apart += here * field.at(u + 8, v);
      within += share_below(static_cast<float>(here)) < 0.25F;
    }
  EXPECT_NEAR(square / 40'000, 1, 0.05);
  EXPECT_NEAR(beside / square, 0.7, 0.15);
  EXPECT_NEAR(apart / square, 0, 0.05);
  EXPECT_NEAR(within / 40'000.0, 0.25, 0.02);
}

TEST(SensorNames, AreThoseOfTheOptions) {
  EXPECT_EQ(*sensor_model_of("l515-real"), SensorModel::l515_real);
  EXPECT_EQ(*sensor_model_of("tof"), SensorModel::tof);
  EXPECT_THAT(sensor_model_of("sonar").error().message, testing::HasSubstr("sonar"));
}

}  // namespace
}  // namespace liloc::sim
