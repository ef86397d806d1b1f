#include "common/wire/dds/entity.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

namespace liloc::wire {
namespace {

/// An entity that needs no network.
Entity condition() {
  return checked(dds_create_guardcondition(DDS_CYCLONEDDS_HANDLE), "condition").value();
}

bool lives(std::int32_t handle) {
  bool set = false;
  return dds_read_guardcondition(handle, &set) == DDS_RETCODE_OK;
}

TEST(Entity, LivesAsLongAsItsOwner) {
  std::int32_t handle = 0;
  {
    const Entity owner = condition();
    handle = owner.handle();
    EXPECT_TRUE(lives(handle));
  }
  EXPECT_FALSE(lives(handle));
}

TEST(Entity, MovesWithItsOwnerAndReplacesWhatThatHad) {
  Entity first = condition(), second = condition();
  const std::int32_t kept = first.handle(), replaced = second.handle();
  {
    Entity moved(std::move(first));
    EXPECT_EQ(moved.handle(), kept);
    second = std::move(moved);
  }
  EXPECT_EQ(second.handle(), kept);
  EXPECT_TRUE(lives(kept));
  EXPECT_FALSE(lives(replaced));
}

TEST(Checked, AnErrorHasItsTextAndItsRemedy) {
  EXPECT_TRUE(check(DDS_RETCODE_OK, "write"));
  const std::pair<dds_return_t, const char*> cases[] = {
      {DDS_RETCODE_PRECONDITION_NOT_MET, "port taken"},
      {DDS_RETCODE_OUT_OF_RESOURCES, "limits"},
      {DDS_RETCODE_TIMEOUT, "does not keep up"},
      {DDS_RETCODE_BAD_PARAMETER, "idl/"},
      {DDS_RETCODE_NOT_ALLOWED_BY_SECURITY, "credentials"},
      {DDS_RETCODE_ERROR, "ip addr"},
      {DDS_RETCODE_ALREADY_DELETED, dds_strretcode(-DDS_RETCODE_ALREADY_DELETED)}};
  for (const auto& [code, says] : cases) {
    const auto failed = check(code, "write of a reply");
    ASSERT_FALSE(failed);
    EXPECT_NE(failed.error().message.find("DDS write of a reply: "), std::string::npos);
    EXPECT_NE(failed.error().message.find(says), std::string::npos) << failed.error().message;
    EXPECT_EQ(checked(code, "write of a reply").error().message, failed.error().message);
  }
}

}  // namespace
}  // namespace liloc::wire
