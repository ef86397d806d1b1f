#include "common/recording/json_fields.hpp"

#include <gmock/gmock.h>

#include "common/recording/tests/temporary_folder.hpp"

namespace liloc {
namespace {

using testing::HasSubstr;

template <class T>
std::string error_of(const Result<T>& result) {
  return result ? "none" : result.error().message;
}

TEST(JsonFields, ErrorsNameTheFieldWhatStandsThereAndTheRemedy) {
  const auto object =
      nlohmann::json::parse(R"({"text":7,"number":"7","big":11,"pose":[1],"half":{"translation":[0,0,0]}})");
  const JsonFields fields(object, "a.json: list[1]");
  EXPECT_EQ(error_of(fields.text("text")), "a.json: list[1].text is 7; give a text");
  EXPECT_EQ(error_of(fields.text("none")), "a.json: list[1].none is missing; give a text");
  EXPECT_EQ(error_of(fields.number("number", 0, 10)), R"(a.json: list[1].number is "7"; give a number)");
  EXPECT_EQ(error_of(fields.number("big", 0, 10)), "a.json: list[1].big is 11; must be 0..10");
  EXPECT_THAT(error_of(fields.pose("pose")), HasSubstr("pose is [1]; give translation and rotation_xyzw"));
  EXPECT_THAT(error_of(fields.pose("half")), HasSubstr("half.rotation_xyzw is missing; give 4 numbers"));
  EXPECT_TRUE(fields.number("big", 0, 11));
}

TEST(JsonFields, WhatStandsThereIsShortAndSafeToPrint) {
  const nlohmann::json object{{"long", std::string(500, 'x')}, {"control", "\x1b[2J\n\xff"}};
  const JsonFields fields(object, "a.json");
  EXPECT_LT(error_of(fields.number("long", 0, 1)).size(), 100U);
  EXPECT_EQ(error_of(fields.number("control", 0, 1)).find_first_of("\x1b\n\xff"), std::string::npos);
}

TEST(JsonFields, PosesAndCamerasComeBack) {
  Pose T = Pose::Identity();
  T.linear() = so3_exp({0.3, -1.2, 2.1});
  T.translation() = Eigen::Vector3d(1, -2, 3.25);
  const Camera camera{64, 48, 45.7, 46.1, 31.5, 23.5, 0.00025};
  nlohmann::ordered_json written;
  written["T"] = pose_to_json(T);
  put_camera(written, camera);
  const nlohmann::json object = nlohmann::json::parse(written.dump());
  const JsonFields fields(object, "a.json");
  EXPECT_TRUE(fields.pose("T")->isApprox(T, 1e-12));
  const auto back = fields.camera();
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->width, 64);
  EXPECT_EQ(back->fy, 46.1);
  EXPECT_EQ(back->depth_scale_m, 0.00025);
}

TEST(ReadJsonObject, NamesTheLineAndNothingOfTheText) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    return error_of(read_json_object(folder.put("a.json", text).string()));
  };
  EXPECT_THAT(error("{\n\"a\": 1,\n\x1b}"), HasSubstr("line 3 is not valid JSON; mend it"));
  EXPECT_THAT(error("[1]"), HasSubstr("holds array; it must be one JSON object"));
  EXPECT_THAT(error(R"({"a":{"b":1,"b":2}})"), HasSubstr(R"("b" stands twice)"));
  EXPECT_EQ(error(R"({"a":{"b":1},"c":{"b":2}})"), "none") << "once in each";
  EXPECT_THAT(error(R"({"a":1e999})"), HasSubstr("a number is out of range"));
  EXPECT_THAT(error_of(read_json_object((folder.path() / "none").string())), HasSubstr("no such file"));
}

}  // namespace
}  // namespace liloc
