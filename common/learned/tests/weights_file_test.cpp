#include "common/learned/weights_file.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <limits>
#include <random>

#include "common/learned/tests/random_network.hpp"
#include "common/learned/tests/weights_bytes.hpp"

namespace liloc::learned {
namespace {

using testing::HasSubstr;

/// A header of one array of two numbers, with what is given in place of its fields.
std::string array_header(const std::string& dtype, const std::string& shape, const std::string& offsets) {
  return R"({"a":{"dtype":)" + dtype + R"(,"shape":)" + shape + R"(,"data_offsets":)" + offsets + "}}";
}

TEST(WeightsFile, ReadsWhatWasWritten) {
  const WeightsFile written = RandomWeights::of(3, {});
  const auto read = parse_weights(bytes_of(written));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->about, written.about);
  ASSERT_EQ(read->arrays.size(), written.arrays.size());
  for (const auto& [name, array] : written.arrays) {
    EXPECT_EQ(read->arrays.at(name).shape, array.shape);
    EXPECT_EQ(read->arrays.at(name).values, array.values);
  }
}

TEST(WeightsFile, RefusesWhatIsNoArrayOfFloats) {
  const std::string eight(8, '\0');
  for (const auto& [header, why] : {
           std::pair{array_header(R"("F32")", "[2]", "[0,8]"), ""},
           {array_header(R"("F16")", "[2]", "[0,8]"), "dtype"},
           {array_header("7", "[2]", "[0,8]"), "dtype"},
           {array_header(R"("F32")", "[3]", "[0,8]"), "another size"},
           {array_header(R"("F32")", "[0]", "[0,0]"), "shape"},
           {array_header(R"("F32")", "[]", "[0,4]"), "shape"},
           {array_header(R"("F32")", "[-2]", "[0,8]"), "shape"},
           {array_header(R"("F32")", "[2.0]", "[0,8]"), "shape"},
           {array_header(R"("F32")", "[4294967296,4294967296,4294967296]", "[0,8]"), "shape"},
           {array_header(R"("F32")", R"("2")", "[0,8]"), "shape"},
           {array_header(R"("F32")", "[2]", "[8,16]"), "outside"},
           {array_header(R"("F32")", "[2]", "[8,0]"), "outside"},
           {array_header(R"("F32")", "[2]", "[0]"), "outside"},
           {array_header(R"("F32")", "[2]", "[0,18446744073709551615]"), "outside"},
           {array_header(R"("F32")", "[[2]]", "[0,8]"), "header"},
           {R"({"a":7})", "dtype"},
           {R"({"a":[]})", "dtype"},
           {R"({"__metadata__":7})", "__metadata__"},
           {R"({"__metadata__":{"a":7}})", "__metadata__"},
           {"[]", "header"},
           {"{", "header"},
           {"", "header"},
           {R"({"__metadata__":{},"__metadata__":{}})", "twice"},
       }) {
    const auto read = parse_weights(with_header(header, eight));
    EXPECT_EQ(read.has_value(), std::string(why).empty()) << header;
    if (!read) {
      EXPECT_THAT(read.error().message, HasSubstr(why)) << header;
    }
  }
}

TEST(WeightsFile, RefusesArraysThatShareBytes) {
  const std::string header =
      R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},"b":{"dtype":"F32","shape":[2],"data_offsets":[0,8]}})";
  const auto read = parse_weights(with_header(header, std::string(8, '\0')));
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("share"));
}

TEST(WeightsFile, RefusesNumbersThatAreNone) {
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    WeightsFile file;
    file.arrays["layer.kernel"] = {{3}, {1, value, 2}};
    const auto read = parse_weights(bytes_of(file));
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr("\"layer.kernel\" has values that are no numbers"));
  }
}

TEST(WeightsFile, RefusesDeepNesting) {
  const std::string deep = R"({"a":)" + std::string(200'000, '[') + std::string(200'000, ']') + "}";
  EXPECT_FALSE(parse_weights(with_header(deep)));
}

TEST(WeightsFile, SurvivesAnyDamage) {
  const std::string whole = bytes_of(RandomWeights::of(3, {{2, 2}, {2, 2}, 3, 2}));
  std::mt19937_64 rng(11);
  for (std::size_t length = 0; length < whole.size(); length += 1 + length / 16)
    EXPECT_FALSE(parse_weights(std::string_view(whole).substr(0, length))) << length;
  for (int i = 0; i < 500; ++i) {
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k) damaged[rng() % 4000] = static_cast<char>(rng());
    (void)parse_weights(damaged);
  }
}

class WeightsOnDisk : public testing::Test {
 protected:
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "liloc_weights_file_test.safetensors";
  void TearDown() override { std::filesystem::remove(path); }
};

TEST_F(WeightsOnDisk, AreReadByName) {
  std::ofstream(path, std::ios::binary) << bytes_of(RandomWeights::of(3, {}));
  const auto read = read_weights(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_FALSE(read->arrays.empty());
}

TEST_F(WeightsOnDisk, NameTheFileInErrors) {
  const auto none = read_weights(path);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr(path.string()));
  std::ofstream(path, std::ios::binary) << "PK\3\4 what torch.save writes";
  const auto torch = read_weights(path);
  ASSERT_FALSE(torch);
  EXPECT_THAT(torch.error().message, HasSubstr(path.string() + ": it is not in the format of safetensors"));
  EXPECT_FALSE(read_weights(testing::TempDir())) << "a folder";
  EXPECT_FALSE(read_weights("/dev/zero")) << "a device, which never ends";
}

}  // namespace
}  // namespace liloc::learned
