// What the fuzzer starts from is sound, and a few thousand changed inputs a border, the same in every run, do
// no harm. `deploy/fuzz` looks further, led by coverage.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "proto-tests/fuzz/border.hpp"

namespace liloc::fuzz {
namespace {

class EachBorder : public testing::TestWithParam<std::size_t> {
 protected:
  const Border& border = borders().at(GetParam());
};

std::string mutant(std::string bytes, std::mt19937& random) {
  const auto pick = [&](std::size_t below) { return random() % std::max<std::size_t>(below, 1); };
  for (std::size_t change = 0; change < 1 + pick(4) && !bytes.empty(); ++change) {
    const std::size_t at = pick(bytes.size());
    switch (pick(5)) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << pick(8)));
        break;
      case 2:
        bytes.resize(at);
        break;
      case 3:
        bytes.insert(at, bytes.substr(pick(bytes.size()), pick(16)));
        break;
      default:
        for (std::size_t i = at; i < std::min(at + 8, bytes.size()); ++i) bytes[i] = '\xff';  // -1, NaN, huge
    }
  }
  return bytes;
}

TEST_P(EachBorder, TakesItsSeeds) {
  ASSERT_FALSE(border.seeds.empty());
  for (const std::string& seed : border.seeds) {
    EXPECT_LE(seed.size(), 8192U);
    const Status taken = border.read(seed);
    EXPECT_TRUE(taken) << border.name << ": " << taken.error().message;
  }
}

TEST_P(EachBorder, RefusesWhatIsEmptyOrNoise) {
  EXPECT_FALSE(border.read(std::string(64, '\xff'))) << border.name;
  const std::set<std::string> tables{"toml", "imu-csv", "tum"};  // of no rows, which is sound
  EXPECT_EQ(bool(border.read("")), tables.contains(border.name)) << border.name;
}

TEST_P(EachBorder, StandsUpToChangedSeeds) {
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string bytes = mutant(border.seeds.at(random() % border.seeds.size()), random);
    if (border.mend) border.mend(bytes);
    refused += border.read(bytes) ? 0 : 1;
  }
  EXPECT_GT(refused, 0) << border.name;
}

INSTANTIATE_TEST_SUITE_P(Fuzz, EachBorder, testing::Range<std::size_t>(0, borders().size()),
                         [](const auto& of) {
                           std::string name = borders().at(of.param).name;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST(Borders, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Border& border : borders()) EXPECT_TRUE(names.insert(border.name).second) << border.name;
  EXPECT_GE(names.size(), 20U);
}

TEST(Pcd, AZeroByteInTheHeaderIsRefused) {  // PCL read on behind it and ended the process
  const auto pcd = std::ranges::find(borders(), "pcd", &Border::name);
  ASSERT_NE(pcd, borders().end());
  std::string bytes = pcd->seeds.back();
  bytes.insert(bytes.find("FIELDS"), std::string("\0\0\0?\0\0\0?\n", 9));
  EXPECT_FALSE(pcd->read(bytes));
}

TEST(PngMending, LetsAChangeInThePictureThrough) {
  const auto png = std::ranges::find(borders(), "png", &Border::name);
  ASSERT_NE(png, borders().end());
  std::string bytes = png->seeds.front();
  const std::string before = bytes;
  png->mend(bytes);
  EXPECT_EQ(bytes, before);
  bytes[bytes.find("IHDR") + 4 + 13] ^= 0x55;  // the header's checksum
  EXPECT_FALSE(png->read(bytes));
  png->mend(bytes);
  EXPECT_TRUE(png->read(bytes));
}

}  // namespace
}  // namespace liloc::fuzz
