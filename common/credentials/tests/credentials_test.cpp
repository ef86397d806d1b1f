#include "common/credentials/credentials.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <thread>

#include "keystore.hpp"

namespace liloc {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

/// One keystore for all tests; each takes its own copy of a folder.
class CredentialsOf : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    store = new Keystore;
    ASSERT_TRUE(store->run("init") && store->run("server edge") && store->run("device robot1") &&
                store->run("device robot2") && store->run("init", "foreign") &&
                store->run("device robot1", "foreign"));
  }
  static void TearDownTestSuite() { delete store; }
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder = store->copy(store->party("robot1"), name);
  }
  void take(const char* file, const fs::path& from) const {
    fs::copy_file(from / file, folder / file, fs::copy_options::overwrite_existing);
  }
  [[nodiscard]] std::string error() const {
    const auto read = read_credentials(folder);
    return read ? "" : read.error().message;
  }

  static Keystore* store;
  fs::path folder;
};
Keystore* CredentialsOf::store = nullptr;

TEST_F(CredentialsOf, AFolderAsMadeIsReadWithItsNameKindAndEnd) {
  const auto read = read_credentials(folder);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->name, "robot1");
  EXPECT_EQ(read->kind, "device");
  EXPECT_FALSE(read->key_exposed);
  EXPECT_NEAR(days_left(*read, std::chrono::system_clock::now()), 365, 1);
  EXPECT_EQ(read_credentials(store->party("edge"))->kind, "server");
}

TEST_F(CredentialsOf, EachMissingFileIsNamed) {
  for (const auto& file : read_credentials(folder)->files()) {
    const fs::path away = folder / "away";
    fs::rename(file, away);
    EXPECT_THAT(error(), HasSubstr(file.filename().string() + " is missing"));
    fs::rename(away, file);
  }
}

TEST_F(CredentialsOf, EachDamagedFileIsNamed) {
  for (const auto& file : read_credentials(folder)->files()) {
    fs::copy_file(file, folder / "whole", fs::copy_options::overwrite_existing);
    std::ofstream(file, std::ios::trunc) << "-----BEGIN CERTIFICATE-----\nMIIB\n-----END CERTIFICATE-----\n";
    EXPECT_THAT(error(), HasSubstr(file.filename().string())) << file;
    fs::copy_file(folder / "whole", file, fs::copy_options::overwrite_existing);
  }
  EXPECT_EQ(error(), "");
}

TEST_F(CredentialsOf, AKeyThatMayNotBeReadIsNamed) {
  if (geteuid() == 0) GTEST_SKIP() << "SKIPPED: root may read every file";
  fs::permissions(folder / "key.pem", fs::perms::none);
  EXPECT_THAT(error(), HasSubstr("key.pem"));
}

TEST_F(CredentialsOf, AKeyThatOthersMayReadIsTold) {
  fs::permissions(folder / "key.pem", fs::perms::group_read, fs::perm_options::add);
  EXPECT_TRUE(read_credentials(folder)->key_exposed);
}

TEST_F(CredentialsOf, ACertificateOfAnotherSiteIsRefused) {
  take("cert.pem", store->party("robot1", "foreign"));
  EXPECT_THAT(error(), HasSubstr("cert.pem is not of identity_ca.cert.pem"));
}

TEST_F(CredentialsOf, AnotherDevicesKeyIsRefused) {
  take("key.pem", store->party("robot2"));
  EXPECT_THAT(error(), HasSubstr("key.pem is not the key of cert.pem"));
}

TEST_F(CredentialsOf, AnotherDevicesPermissionsAreRefused) {
  take("permissions.p7s", store->party("robot2"));
  EXPECT_THAT(error(), HasSubstr("permissions.p7s is not for CN=robot1,OU=device,O=LiLoc"));
}

TEST_F(CredentialsOf, PermissionsThatWereChangedOrSignedByOthersAreRefused) {
  take("permissions.p7s", store->party("robot1", "foreign"));
  EXPECT_THAT(error(), HasSubstr("permissions.p7s is not signed by permissions_ca.cert.pem"));
  ASSERT_TRUE(store->shell("sed s,robots/robot1,robots/robot2, " + store->party("robot1").string() +
                           "/permissions.p7s > " + folder.string() + "/permissions.p7s"));
  EXPECT_THAT(error(), HasSubstr("permissions.p7s is not signed by permissions_ca.cert.pem"));
}

TEST_F(CredentialsOf, PermissionsThatTheIdentityAuthoritySignedAreRefused) {
  const std::string ca = store->authority().string() + "/identity_ca";
  ASSERT_TRUE(store->shell(
      "echo '<subject_name>CN=robot1,OU=device,O=LiLoc</subject_name>' | openssl smime -sign -text "
      "-signer " +
      ca + ".cert.pem -inkey " + ca + ".key -out " + folder.string() + "/permissions.p7s"));
  EXPECT_THAT(error(), HasSubstr("permissions.p7s is not signed by permissions_ca.cert.pem"));
}

TEST_F(CredentialsOf, OneAuthorityForBothIsRefused) {
  fs::copy_file(folder / "identity_ca.cert.pem", folder / "permissions_ca.cert.pem",
                fs::copy_options::overwrite_existing);
  EXPECT_THAT(error(), HasSubstr("one CA for identities and permissions"));
}

TEST_F(CredentialsOf, AnExpiredCertificateIsRefused) {
  ASSERT_TRUE(store->run("device old --expires $(date -u -d '+2 seconds' +%Y-%m-%dT%H:%M:%S)"));
  EXPECT_TRUE(read_credentials(store->party("old")));
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));
  const auto read = read_credentials(store->party("old"));
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message,
              HasSubstr("has expired; deploy/credentials renew old, and copy its folder again"));
}

TEST_F(CredentialsOf, AnOutdatedRevocationListIsRefusedAndTheNextRevocationMakesANewOne) {
  const std::string authority = store->authority().string();
  ASSERT_TRUE(store->run("device robot3") &&
              store->shell("LILOC_AUTHORITY=" + authority + " openssl ca -config " + authority +
                           "/openssl.cnf -gencrl -crlsec 1 -out " + folder.string() + "/crl.pem"));
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));
  EXPECT_THAT(error(), HasSubstr("crl.pem has expired; deploy/credentials revoke makes a new one"));
  ASSERT_TRUE(store->run("revoke robot3"));
  take("crl.pem", store->party("robot1"));
  EXPECT_EQ(error(), "");
}

TEST_F(CredentialsOf, ARevokedCertificateIsRefusedAndARenewedOneIsTaken) {
  ASSERT_TRUE(store->run("device lost") && store->run("revoke lost"));
  const auto read = read_credentials(store->party("lost"));
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("cert.pem is revoked"));
  ASSERT_TRUE(store->run("renew lost"));
  EXPECT_TRUE(read_credentials(store->party("lost")));
}

TEST_F(CredentialsOf, WhatIsNoFolderIsRefused) {
  EXPECT_THAT(read_credentials("/nowhere").error().message, HasSubstr("/nowhere is no folder"));
  EXPECT_FALSE(read_credentials(folder / "cert.pem"));
}

}  // namespace
}  // namespace liloc
