#pragma once
// The folder by which a party proves who it is, as `deploy/credentials` makes it: checked before DDS sees it,
// so that what is wrong is told by file and remedy. The names of the files are those of an enclave of ROS 2.
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace liloc {

struct Credentials {
  std::filesystem::path folder;  ///< absolute
  std::string name;              ///< of the certificate: the id of a device or LiDAR, the name of a server
  std::string kind;              ///< "server", "device" or "lidar", as the certificate says
  std::chrono::sys_seconds expires;
  bool key_exposed = false;  ///< others than its owner may read the private key

  [[nodiscard]] std::filesystem::path identity_ca() const { return folder / "identity_ca.cert.pem"; }
  [[nodiscard]] std::filesystem::path permissions_ca() const { return folder / "permissions_ca.cert.pem"; }
  [[nodiscard]] std::filesystem::path certificate() const { return folder / "cert.pem"; }
  [[nodiscard]] std::filesystem::path key() const { return folder / "key.pem"; }
  [[nodiscard]] std::filesystem::path governance() const { return folder / "governance.p7s"; }
  [[nodiscard]] std::filesystem::path permissions() const { return folder / "permissions.p7s"; }
  [[nodiscard]] std::filesystem::path revoked() const { return folder / "crl.pem"; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
};

/// Reads and checks all of `folder` against the clock. Errors name the file: missing, unreadable or damaged;
/// the certificate has expired, is revoked, or is not of this identity CA; the key is not the certificate's;
/// one CA for identities and permissions; a document that the permissions CA did not sign, or that is for
/// somebody else.
[[nodiscard]] Result<Credentials> read_credentials(const std::filesystem::path& folder);

constexpr int kRenewDays = 30;  ///< so long before their end, credentials are complained of; by hand

/// Whole days until `credentials` expire, at `now`; negative when they have.
[[nodiscard]] int days_left(const Credentials& credentials, std::chrono::system_clock::time_point now);
/// To the log: that they end within `kRenewDays`, or that others can read the private key.
void warn_of(const Credentials& credentials, std::chrono::system_clock::time_point now);

}  // namespace liloc
