#include "common/registration/field/field_layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/registration/field/score_field.hpp"
#include "common/testing/changed_room.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class FieldLayersLaw : public testing::TestWithParam<unsigned> {};

Cloud scattered(unsigned seed, std::size_t count) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<float> unit(0, 1);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.emplace_back(unit(rng), unit(rng), 0.5F * unit(rng));
    cloud.normals.push_back(Eigen::Vector3f(unit(rng), unit(rng), unit(rng)).normalized());
  }
  return cloud;
}

template <class Visit>
void for_each_cell(const FieldLayers& layers, const Visit& visit) {
  for (int z = 0; z < layers.size().z(); ++z)
    for (int y = 0; y < layers.size().y(); ++y)
      for (int x = 0; x < layers.size().x(); ++x)
        visit(x, y, z,
              Eigen::Vector3f(layers.origin() + static_cast<float>(layers.cell_m()) *
                                                    Eigen::Vector3f(x + 0.5F, y + 0.5F, z + 0.5F)));
}

/// A Gaussian of the distance to the nearest of the points, which reaches 2.2 standard deviations.
int nearness(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& at, double sd_m) {
  double least = 1e9;
  for (const Eigen::Vector3f& p : points) least = std::min(least, static_cast<double>((p - at).norm()));
  return least > 2.2 * sd_m
             ? 0
             : static_cast<int>(std::lround(FieldLayers::kNear * std::exp(-least * least / (2 * sd_m * sd_m))));
}

TEST_P(FieldLayersLaw, ACellIsAsNearAsItsNearestSurface) {
  const Cloud cloud = scattered(GetParam(), 60);
  const FieldOptions options;
  const FieldLayers layers(cloud, {}, options);
  std::size_t cells = 0, differ = 0;
  for_each_cell(layers, [&](int x, int y, int z, const Eigen::Vector3f& centre) {
    const int expected = nearness(cloud.points, centre, options.surface_sd_m);
    cells += expected > 0;
    differ += layers.near(y, z, FieldLayers::kAny)[x] != expected;
  });
  EXPECT_GT(cells, 500U);
  EXPECT_LE(differ, cells / 200) << "but for rounding";
}

TEST_P(FieldLayersLaw, APlaneHoldsTheSurfacesThatFaceItsWayWithinSixtyDegrees) {
  const Cloud cloud = scattered(GetParam(), 60);
  const FieldOptions options;
  const FieldLayers layers(cloud, {}, options);
  for (const int plane : {0, 3, FieldLayers::kUp, FieldLayers::kDown}) {
    const double azimuth = 2 * M_PI * plane / FieldLayers::kAzimuths;
    const Eigen::Vector3f way = plane == FieldLayers::kUp ? Eigen::Vector3f(0, 0, 1)
                                : plane == FieldLayers::kDown
                                    ? Eigen::Vector3f(0, 0, -1)
                                    : Eigen::Vector3f(std::cos(azimuth), std::sin(azimuth), 0);
    std::vector<Eigen::Vector3f> facing;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (cloud.normals[i].dot(way) > 0.5F) facing.push_back(cloud.points[i]);
    std::size_t differ = 0, cells = 0;
    for_each_cell(layers, [&](int x, int y, int z, const Eigen::Vector3f& centre) {
      const int expected = nearness(facing, centre, options.surface_sd_m);
      cells += expected > 0;
      differ += layers.near(y, z, plane)[x] != expected;
    });
    EXPECT_GT(cells, 50U);
    EXPECT_LE(differ, cells / 100) << plane;
  }
}

TEST_P(FieldLayersLaw, WithoutNormalsASurfaceFacesEverywhere) {
  Cloud bare = scattered(GetParam(), 20);
  bare.normals.clear();
  const FieldLayers layers(bare, {}, {});
  for_each_cell(layers, [&](int x, int y, int z, const Eigen::Vector3f&) {
    for (int plane = 0; plane < FieldLayers::kDirections; ++plane)
      ASSERT_EQ(layers.near(y, z, plane)[x], layers.near(y, z, FieldLayers::kAny)[x]);
  });
}

TEST_P(FieldLayersLaw, ThroughCountsTheSensorsThatLookThrough) {
  const WatchedRoom w = watched_room(GetParam());
  const FieldOptions options{.cell_m = 0.2};
  const FieldLayers layers(w.target->cloud, w.target.views, options);
  const auto tolerance_m = static_cast<float>(0.5 * options.cell_m + 0.03);  // half a cell, and noise
  std::size_t seen = 0, differ = 0;
  for_each_cell(layers, [&](int x, int y, int z, const Eigen::Vector3f& centre) {
    const auto expected = std::ranges::count_if(
        w.target.views, [&](const SightView& v) { return v.look(centre, tolerance_m) == Sight::conflict; });
    seen += expected > 0;
    differ += layers.through(y, z)[x] != expected;
  });
  EXPECT_GT(seen, 1000U);
  EXPECT_LE(differ, seen / 500) << "but for rounding at the rim of a pixel";
}

void expect_same(const FieldLayers& a, const FieldLayers& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.origin(), b.origin());
  std::size_t differ = 0;
  for_each_cell(a, [&](int x, int y, int z, const Eigen::Vector3f&) {
    differ += a.through(y, z)[x] != b.through(y, z)[x];
    for (int plane = 0; plane <= FieldLayers::kAny; ++plane)
      differ += a.near(y, z, plane)[x] != b.near(y, z, plane)[x];
  });
  EXPECT_EQ(differ, 0U);
}

TEST_P(FieldLayersLaw, MadeOfEarlierOnesTheyAreThoseMadeAnew) {
  const WatchedRoom w = watched_room(GetParam());
  std::mt19937_64 rng(GetParam());
  const FieldLayers before(w.target->cloud, w.target.views, {});
  const Cloud now = changed(w.target->cloud, rng);
  std::vector<SightView> views = watch(w.room, GetParam() + 100).views;  // one has measured anew
  views[0] = w.target.views[0];
  const CloudChange change = change_between(w.target->cloud, now);
  ASSERT_TRUE(change.little(now.size()));
  expect_same(FieldLayers(now, views, {}, {before, w.target.views, change}), FieldLayers(now, views, {}));
  views.pop_back();  // nor do they hang on the same sensors
  expect_same(FieldLayers(now, views, {}, {before, w.target.views, change}), FieldLayers(now, views, {}));
}

TEST_P(FieldLayersLaw, WhatStoodAtTheRimOfARegionAndIsGoneLeavesNothing) {
  const WatchedRoom w = watched_room(GetParam());
  const Cloud& now = w.target->cloud;
  const Region region = regions_of(now.points, kFarApart_m).front();
  Cloud before = now;  // with a curtain, so near to the wall that the grid is the same
  const double beyond_m = region.max().x() + 1e-3;
  for (int i = 0; i < 20; ++i) {
    before.points.emplace_back(static_cast<float>(beyond_m),
                               static_cast<float>(region.center().y()) + 0.05F * i, 1.0F);
    before.normals.emplace_back(-1, 0, 0);
  }
  const FieldLayers earlier(before, w.target.views, {}, regions_of(before.points, kFarApart_m).front());
  const FieldLayers anew(now, w.target.views, {}, region);
  ASSERT_EQ(earlier.size(), anew.size());
  const CloudChange change = change_between(before, now);
  ASSERT_TRUE(change.little(now.size()));
  expect_same(FieldLayers(now, w.target.views, {}, {earlier, w.target.views, change}, region), anew);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FieldLayersLaw, testing::Range(1U, 4U));

TEST(FieldLayers, OfNothingAreEmptyAndOfABuildingCoarser) {
  EXPECT_TRUE(FieldLayers({}, {}, {}).empty());
  Cloud nowhere;
  nowhere.points.assign(3, Eigen::Vector3f::Constant(NAN));
  EXPECT_TRUE(FieldLayers(nowhere, {}, {}).empty());
  const Cloud wide{{{0, 0, 0}, {200, 200, 10}}, {}};  // 4e8 cells of 0.1 m
  const FieldLayers layers(wide, {}, {});
  EXPECT_GT(layers.cell_m(), 0.3);
  EXPECT_LT(layers.size().cast<double>().prod(), 10e6);
}

}  // namespace
}  // namespace liloc
