#include "common/credentials/credentials.hpp"

#include <openssl/x509_vfy.h>

#include <ctime>

#include "common/base/log.hpp"
#include "common/credentials/pem.hpp"

namespace liloc {
namespace {

using std::filesystem::path;

/// Any of these a program refuses at once; DDS would say no more than that there was an error.
Status check_certificate(const Credentials& c, X509& certificate, X509& ca, X509_CRL& revoked) {
  const std::string file = c.certificate().string();
  switch (const int why = pem::verify(certificate, ca, revoked)) {
    case X509_V_OK:
      return {};
    case X509_V_ERR_CERT_HAS_EXPIRED:
      return fail("{} has expired; deploy/credentials renew {}, and copy its folder again", file, c.name);
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return fail("{} is not valid yet; set this machine's clock", file);
    case X509_V_ERR_CERT_REVOKED:
      return fail("{} is revoked; deploy/credentials renew {}, if that was an error", file, c.name);
    case X509_V_ERR_CRL_HAS_EXPIRED:
      return fail("{} has expired; deploy/credentials revoke makes a new one: copy that", c.revoked().string());
    case X509_V_ERR_UNABLE_TO_GET_CRL:
    case X509_V_ERR_CRL_SIGNATURE_FAILURE:
      return fail("{} is not of identity_ca.cert.pem; copy the whole folder anew", c.revoked().string());
    default:
      return fail("{} is not of identity_ca.cert.pem ({}); copy the whole folder anew", file,
                  X509_verify_cert_error_string(why));
  }
}

/// With one key for both, whoever has a certificate can sign permissions for himself (CVE-2023-24011 in Cyclone
/// DDS 0.10.2).
bool same_key(const X509& a, const X509& b) {
  return EVP_PKEY_eq(X509_get0_pubkey(&a), X509_get0_pubkey(&b)) == 1;
}

Status check_documents(const Credentials& c, const X509& certificate, X509& permissions_ca) {
  if (const auto governance = pem::read_signed(c.governance(), permissions_ca); !governance)
    return tl::unexpected(governance.error());
  const auto permissions = pem::read_signed(c.permissions(), permissions_ca);
  if (!permissions) return tl::unexpected(permissions.error());
  const std::string subject = pem::subject(certificate);
  if (permissions->find("<subject_name>" + subject + "<") == std::string::npos)
    return fail("{} is not for {}, which cert.pem is of; copy the whole folder anew", c.permissions().string(),
                subject);
  return {};
}

/// Where the file is read-only to the world it is a secret to nobody.
bool exposed(const path& key) {
  using std::filesystem::perms;
  std::error_code error;
  const perms mode = std::filesystem::status(key, error).permissions();
  return error || (mode & (perms::group_all | perms::others_all)) != perms::none;
}

Result<std::chrono::sys_seconds> expiry_of(const X509& certificate) {
  std::tm utc{};
  if (ASN1_TIME_to_tm(X509_get0_notAfter(&certificate), &utc) != 1) return fail("its end is no time");
  return std::chrono::sys_seconds(std::chrono::seconds(timegm(&utc)));
}

}  // namespace

std::vector<path> Credentials::files() const {
  return {identity_ca(), permissions_ca(), certificate(), key(), governance(), permissions(), revoked()};
}

Result<Credentials> read_credentials(const path& folder) {
  std::error_code error;
  Credentials c;
  c.folder = std::filesystem::absolute(folder, error);
  if (!std::filesystem::is_directory(c.folder, error))
    return fail("{} is no folder; deploy/credentials makes one for each party", folder.string());
  const auto identity_ca = pem::read_certificate(c.identity_ca());
  if (!identity_ca) return tl::unexpected(identity_ca.error());
  const auto permissions_ca = pem::read_certificate(c.permissions_ca());
  if (!permissions_ca) return tl::unexpected(permissions_ca.error());
  const auto certificate = pem::read_certificate(c.certificate());
  if (!certificate) return tl::unexpected(certificate.error());
  const auto key = pem::read_key(c.key());
  if (!key) return tl::unexpected(key.error());
  const auto revoked = pem::read_revocation_list(c.revoked());
  if (!revoked) return tl::unexpected(revoked.error());
  c.name = pem::subject_part(**certificate, NID_commonName);
  c.kind = pem::subject_part(**certificate, NID_organizationalUnitName);
  const auto expires = expiry_of(**certificate);
  if (!expires) return fail("{}: {}", c.certificate().string(), expires.error().message);
  c.expires = *expires;
  c.key_exposed = exposed(c.key());
  if (same_key(**identity_ca, **permissions_ca))
    return fail(
        "{}: one CA for identities and permissions lets every device sign its own permissions; make two: "
        "deploy/credentials init",
        c.folder.string());
  if (const Status ok = check_certificate(c, **certificate, **identity_ca, **revoked); !ok)
    return tl::unexpected(ok.error());
  if (EVP_PKEY_eq(key->get(), X509_get0_pubkey(certificate->get())) != 1)
    return fail("{} is not the key of cert.pem; copy the whole folder anew", c.key().string());
  if (const Status ok = check_documents(c, **certificate, **permissions_ca); !ok)
    return tl::unexpected(ok.error());
  return c;
}

void warn_of(const Credentials& credentials, std::chrono::system_clock::time_point now) {
  if (const int days = days_left(credentials, now); days < kRenewDays)
    log::warning("{} expires in {} days; deploy/credentials renew {}, and copy its folder again",
                 credentials.certificate().string(), days, credentials.name);
  if (credentials.key_exposed) log::warning("{} can be read by others; chmod 600", credentials.key().string());
}

int days_left(const Credentials& credentials, std::chrono::system_clock::time_point now) {
  return static_cast<int>(std::chrono::floor<std::chrono::days>(credentials.expires - now).count());
}

}  // namespace liloc
