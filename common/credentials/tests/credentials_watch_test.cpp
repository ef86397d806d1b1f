#include "common/credentials/credentials_watch.hpp"

#include <gtest/gtest.h>

#include "keystore.hpp"

namespace liloc {
namespace {

TEST(CredentialsWatch, AChangeIsToldOnceAndWhenItHasSettled) {
  const Keystore store;
  ASSERT_TRUE(store.run("init") && store.run("server edge") && store.run("device robot1"));
  CredentialsWatch watch(store.party("edge"));
  EXPECT_FALSE(watch.changed());
  ASSERT_TRUE(store.run("revoke robot1"));
  EXPECT_FALSE(watch.changed()) << "a copy may be under way";
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed());
}

TEST(CredentialsWatch, NoFolderNeverChanges) {
  CredentialsWatch watch("");
  EXPECT_FALSE(watch.changed());
}

}  // namespace
}  // namespace liloc
