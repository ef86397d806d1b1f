#include "server/global_cloud/depth_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace liloc {
namespace {

struct Sensor {
  const char* name;
  double base_m, per_square_m, step_per_square_m, movers;
};

class NoiseLaw : public testing::TestWithParam<std::tuple<Sensor, int>> {};

TEST_P(NoiseLaw, IsWhatTheSensorHas) {
  const Sensor& sensor = std::get<0>(GetParam());
  std::mt19937 rng(static_cast<unsigned>(std::get<1>(GetParam())));
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> range(0.8, 7.5), share(0, 1);
  NoiseMeter meter;
  const auto read = [&](double z) {
    const double off = (sensor.base_m + sensor.per_square_m * z * z) * normal(rng),
                 step = sensor.step_per_square_m * z * z;
    return step > 0 ? step * std::round((z + off) / step) : z + off;
  };
  for (int frame = 0; frame < 40; ++frame) {
    for (int i = 0; i < 500; ++i) {
      const double z = range(rng), later = share(rng) < sensor.movers ? z - 1.5 : z;
      meter.add_pair(z, read(z) - read(later));
    }
    meter.add_frame(1000, 100, 900, 9);
  }
  for (const double z : {2.0, 4.0, 6.0}) {
    const double own = sensor.base_m + sensor.per_square_m * z * z, step = sensor.step_per_square_m * z * z;
    const double sigma = std::hypot(own, step / std::sqrt(12));
    EXPECT_GT(meter.noise().sigma_m(z), 0.85 * sigma) << z;
    EXPECT_LT(meter.noise().sigma_m(z), 1.6 * sigma + 0.001) << z;  // a median of whole steps is a step
  }
  EXPECT_NEAR(meter.noise().missing, 0.1, 0.02);
  EXPECT_NEAR(meter.noise().flying, 0.01, 0.002);
  EXPECT_GT(meter.noise().samples, 10'000U);
}
INSTANTIATE_TEST_SUITE_P(SensorsAndSeeds, NoiseLaw,
                         testing::Combine(testing::Values(Sensor{"l515", 0.004, 0.0002, 0, 0.1},
                                                          Sensor{"l515_real", 0.010, 0.0002, 0, 0.1},
                                                          Sensor{"kinect", 0.0001, 0.00165, 0.00285, 0.1},
                                                          Sensor{"tof", 0.001, 0.0002, 0, 0.2}),
                                          testing::Range(1, 5)),
                         [](const auto& law) {
                           return std::string(std::get<0>(law.param).name) +
                                  std::to_string(std::get<1>(law.param));
                         });

TEST(NoiseMeter, StandsAtWhatWasKnownUntilItHasSamples) {
  DepthNoise known{0.02, 0.003, 0.4, 0.1, 5000};
  NoiseMeter meter(known);
  EXPECT_EQ(meter.noise(), known);
  for (int i = 0; i < 20; ++i) meter.add_frame(0, 0, 0, 0);
  EXPECT_EQ(meter.noise(), known);
}

TEST(NoiseMeter, FollowsASensorThatGetsWorse) {
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  NoiseMeter meter;
  const auto run = [&](double sigma_m, int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      for (int i = 0; i < 5000; ++i) meter.add_pair(3.2, sigma_m * std::sqrt(2.0) * normal(rng));
      meter.add_frame(1, 0, 1, 0);
    }
  };
  run(0.005, 80);
  EXPECT_NEAR(meter.noise().sigma_m(3.2), 0.005, 0.001);
  run(0.02, 160);
  EXPECT_NEAR(meter.noise().sigma_m(3.2), 0.02, 0.004);
}

}  // namespace
}  // namespace liloc
