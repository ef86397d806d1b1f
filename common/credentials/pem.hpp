#pragma once
// Private to the room: OpenSSL's objects with owners, read from files.
#include <openssl/evp.h>
#include <openssl/x509.h>

#include <filesystem>
#include <memory>
#include <string>

#include "common/base/result.hpp"

namespace liloc::pem {

template <auto Free>
struct Deleter {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
using Certificate = std::unique_ptr<X509, Deleter<X509_free>>;
using RevocationList = std::unique_ptr<X509_CRL, Deleter<X509_CRL_free>>;
using Key = std::unique_ptr<EVP_PKEY, Deleter<EVP_PKEY_free>>;

/// Errors name the file: missing, not readable, no regular file, over 1 MB, not of this kind.
[[nodiscard]] Result<Certificate> read_certificate(const std::filesystem::path& file);
[[nodiscard]] Result<RevocationList> read_revocation_list(const std::filesystem::path& file);
/// A key with a password is an error: nobody is there to type it.
[[nodiscard]] Result<Key> read_key(const std::filesystem::path& file);

/// The text of an S/MIME document that `signer` signed. Error: somebody else did, or it was changed.
[[nodiscard]] Result<std::string> read_signed(const std::filesystem::path& file, X509& signer);

/// Whether `certificate` is one of `ca`, is not in `revoked`, and holds now: OpenSSL's X509_V_OK or why not.
[[nodiscard]] int verify(X509& certificate, X509& ca, X509_CRL& revoked);

/// One part of the subject, e.g. NID_commonName; empty where it has none.
[[nodiscard]] std::string subject_part(const X509& certificate, int nid);
/// "CN=robot1,OU=device,O=LiLoc", as permissions name a subject.
[[nodiscard]] std::string subject(const X509& certificate);

}  // namespace liloc::pem
