#include "common/registration/sight/sight_kernel.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <ranges>

namespace liloc {
namespace {

class SightKernelLaw : public testing::TestWithParam<unsigned> {};

Vectors scattered(std::mt19937_64& rng, std::size_t count) {
  std::uniform_real_distribution<float> place(-4, 4);
  Vectors points(count);
  for (std::size_t i = 0; i < count; ++i) points.set(i, {place(rng), place(rng), place(rng)});
  return points;
}

/// One point at a time, by the header's words.
Word word_of(const Pinhole& c, const std::vector<DepthBand>& bands, const Eigen::Vector3f& p_sensor,
             float tolerance_m) {
  if (p_sensor.z() < c.nearest) return kNoWord;
  const float u = p_sensor.x() / p_sensor.z() * c.fx + c.cx, v = p_sensor.y() / p_sensor.z() * c.fy + c.cy;
  if (u < 0 || v < 0 || u >= c.width || v >= c.height) return kNoWord;
  const DepthBand& band =
      bands[static_cast<std::size_t>(v) * static_cast<std::size_t>(c.width) + static_cast<std::size_t>(u)];
  if (band.far == 0) return kNoWord;
  const float slack = tolerance_m + 0.01F * p_sensor.z();
  if (p_sensor.z() < band.edge - 2 * slack) return kLookedThrough;
  const bool at_near = p_sensor.z() <= band.near + slack && p_sensor.z() >= band.near - 2 * slack,
             at_far = std::abs(p_sensor.z() - band.far) <= slack;
  return at_near || at_far ? kMeasured : kNoWord;
}

TEST_P(SightKernelLaw, ManyPointsGetTheWordThatEachGets) {
  std::mt19937_64 rng(GetParam());
  std::uniform_real_distribution<float> depth(0.5F, 5), unit(-1, 1);
  Pinhole camera{{}, {}, 20, 20, 16, 12, 32, 24, 0.2F, 32 * 24};
  const Eigen::Matrix3f R =
      Eigen::Quaternionf(unit(rng), unit(rng), unit(rng), unit(rng)).normalized().toRotationMatrix();
  const Eigen::Vector3f t(unit(rng), unit(rng), unit(rng));
  std::copy_n(R.data(), 9, camera.R);
  std::copy_n(t.data(), 3, camera.t);
  std::vector<DepthBand> bands(32 * 24 + 1);  // the last measured nothing
  for (std::size_t i = 0; i + 1 < bands.size(); ++i)
    if (i % 7 != 0) {
      const float near = depth(rng);
      bands[i] = {near, near + (i % 3 == 0 ? 1.0F : 0.0F), near - (i % 5 == 0 ? 0.4F : 0.0F)};
    }
  constexpr std::size_t kCount = 20003;  // not a multiple of eight
  const Vectors points = scattered(rng, kCount);
  std::vector<std::int32_t> words(kCount);
  for (std::size_t i = 0; i < kCount; ++i) words[i] = static_cast<std::int32_t>(i % 3);
  look_at(camera, bands.data(), points.run(0, kCount), 0.05F, words.data());
  std::size_t differ = 0, through = 0, measured = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const Word word =
        word_of(camera, bands, R * Eigen::Vector3f(points.x[i], points.y[i], points.z[i]) + t, 0.05F);
    through += word == kLookedThrough;
    measured += word == kMeasured;
    differ += words[i] != std::max(static_cast<std::int32_t>(i % 3), static_cast<std::int32_t>(word));
  }
  EXPECT_GT(through, 100U);
  EXPECT_GT(measured, 40U);
  EXPECT_LE(differ, 4U) << "but for rounding at the rim of a pixel";
}

TEST_P(SightKernelLaw, WhatASurfaceShowsByItsEdgeIsNotLookedThrough) {
  std::mt19937_64 rng(GetParam());
  std::uniform_real_distribution<float> side(-0.5F, 0.5F), depth(1, 3), unit(-1, 1);
  Pinhole camera{{}, {}, 20, 20, 16, 12, 32, 24, 0.2F, 32 * 24};
  const Eigen::Matrix3f R =
      Eigen::Quaternionf(unit(rng), unit(rng), unit(rng), unit(rng)).normalized().toRotationMatrix();
  std::copy_n(R.data(), 9, camera.R);
  std::vector<DepthBand> bands(32 * 24 + 1, {5, 5, 5});
  bands.back() = {};
  constexpr std::size_t kCount = 1003;
  constexpr float kNearly_m = 0.04F, kEnough_m = 0.06F;  // along the normal, of a gap in the line of sight
  Vectors points(kCount), along(kCount), across(kCount), unknown(kCount), nearly(kCount), enough(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    const Eigen::Vector3f p_sensor(side(rng), side(rng), depth(rng));
    points.set(i, R.transpose() * p_sensor);
    along.set(i, R.transpose() * p_sensor.unitOrthogonal());
    across.set(i, R.transpose() * -p_sensor.normalized());
    unknown.set(i, Eigen::Vector3f::Zero());
    const Eigen::Vector3f ray = p_sensor.normalized(), side_of = p_sensor.unitOrthogonal();
    const auto leaning = [&](float gap_m) {  // from the line of sight, so that its gap is so much
      const float cosine = gap_m / ((5 - p_sensor.z()) / ray.z());
      return Eigen::Vector3f(R.transpose() * (cosine * ray + std::sqrt(1 - cosine * cosine) * side_of));
    };
    nearly.set(i, leaning(kNearly_m));
    enough.set(i, leaning(kEnough_m));
  }
  const auto through = [&](const Vectors* normals) {
    std::vector<std::int32_t> words(kCount, kNoWord);
    if (normals == nullptr)
      look_at(camera, bands.data(), points.run(0, kCount), 0.02F, words.data());
    else
      look_at(camera, bands.data(), points.run(0, kCount), normals->run(0, kCount), 0.02F, words.data());
    return std::ranges::count(words, kLookedThrough);
  };
  EXPECT_EQ(through(nullptr), kCount);
  EXPECT_EQ(through(&across), kCount);
  EXPECT_EQ(through(&unknown), kCount) << "without a normal a point counts as before";
  EXPECT_EQ(through(&along), 0);
  EXPECT_EQ(through(&nearly), 0) << "5 cm it takes, whatever the tolerance";
  EXPECT_EQ(through(&enough), kCount);
}

TEST_P(SightKernelLaw, ABallReachesInWhereEachHalfSpaceSaysSo) {
  std::mt19937_64 rng(GetParam());
  std::normal_distribution<float> normal(0, 1);
  std::uniform_real_distribution<float> radius(0, 2);
  constexpr std::size_t kCount = 1003;
  const Vectors centres = scattered(rng, kCount);
  std::vector<HalfSpace> spaces;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Vector3f n = Eigen::Vector3f(normal(rng), normal(rng), normal(rng)).normalized();
    spaces.push_back({n.x(), n.y(), n.z(), 1.5F});
  }
  std::vector<float> radii(kCount);
  for (float& r : radii) r = radius(rng);
  std::vector<std::int32_t> reached(kCount, 1);
  reached[5] = 0;  // what was out stays out
  reach_into(spaces.data(), spaces.size(), centres.run(0, kCount), radii.data(), reached.data());
  std::size_t in = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    float margin = std::numeric_limits<float>::infinity();
    for (const HalfSpace& s : spaces)
      margin =
          std::min(margin, s.x * centres.x[i] + s.y * centres.y[i] + s.z * centres.z[i] + s.off + radii[i]);
    if (std::abs(margin) < 1e-5F) continue;  // rounding
    ASSERT_EQ(reached[i] != 0, margin > 0 && i != 5) << i;
    in += margin > 0;
  }
  EXPECT_GT(in, 50U);
  EXPECT_LT(in, kCount - 50);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SightKernelLaw, testing::Range(1U, 6U));

}  // namespace
}  // namespace liloc
