#include "client/session/codec_choice.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

using namespace std::chrono_literals;
using enum CloudCodec;

constexpr CodecChoice::Time kNow{1h};

TEST(CodecChoice, IsTheWantedOneWhereNobodyObjects) {
  for (const CloudCodec wanted : kCloudCodecs) {
    CodecChoice choice(wanted);
    EXPECT_EQ(choice.choose("", kNow), wanted);
    choice.heard("edge1", {octree, voxel, draco}, kNow);
    EXPECT_EQ(choice.choose("edge1", kNow), wanted);
    choice.heard("edge2", {}, kNow);  // says nothing
    EXPECT_EQ(choice.choose("edge1", kNow), wanted);
  }
}

TEST(CodecChoice, IsAnotherThatTheServerReads) {
  CodecChoice choice(draco);
  choice.heard("edge1", {octree, voxel}, kNow);
  EXPECT_EQ(choice.choose("", kNow), voxel);
  choice.heard("edge1", {octree}, kNow + 1s);
  EXPECT_EQ(choice.choose("edge1", kNow + 1s), octree);
  choice.heard("edge1", {}, kNow + 2s);  // updated
  EXPECT_EQ(choice.choose("edge1", kNow + 2s), draco);
}

TEST(CodecChoice, SuitsTheStandbyWhereThatCostsTheFollowedServerNothing) {
  CodecChoice choice(draco);
  choice.heard("edge1", {draco, voxel}, kNow);
  choice.heard("edge2", {voxel}, kNow);
  EXPECT_EQ(choice.choose("edge1", kNow), voxel);
  choice.heard("edge2", {octree}, kNow);
  EXPECT_EQ(choice.choose("edge1", kNow), draco);
  EXPECT_EQ(choice.choose("edge2", kNow), octree);
}

TEST(CodecChoice, ServersThatAreSilentOrThatKnowNoneOfOursDoNotCount) {
  CodecChoice choice(draco);
  choice.heard("edge1", {octree}, kNow);
  EXPECT_EQ(choice.choose("edge1", kNow + 4s), octree);
  EXPECT_EQ(choice.choose("edge1", kNow + 6s), draco);
  CodecChoice fresh(draco);
  fresh.heard("later", {static_cast<CloudCodec>(9)}, kNow);
  EXPECT_EQ(fresh.choose("later", kNow + 1s), draco);
}

TEST(CodecChoice, AFloodOfServersIsBoundedAndTheFirstOnesCount) {
  CodecChoice choice(draco);
  choice.heard("edge1", {draco, octree}, kNow);
  for (int i = 0; i < 5000; ++i) choice.heard("stranger" + std::to_string(i), {voxel}, kNow);
  EXPECT_EQ(choice.choose("edge1", kNow), draco);
}

}  // namespace
}  // namespace liloc
