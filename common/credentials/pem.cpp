#include "common/credentials/pem.hpp"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/x509_vfy.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

namespace liloc::pem {
namespace {

using Bio = std::unique_ptr<BIO, Deleter<BIO_free>>;
constexpr std::uintmax_t kMostBytes = 1 << 20;  // a document of permissions has 2 kB; by hand

Result<std::string> read_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found)
    return fail("{} is missing; copy the whole folder that deploy/credentials made", file.string());
  if (!std::filesystem::is_regular_file(status))
    return fail("{} is not readable as a file{}{}", file.string(), error ? ": " : "", error.message());
  if (std::filesystem::file_size(file, error) > kMostBytes)
    return fail("{} has over 1 MB; copy it anew", file.string());
  std::ifstream in(file, std::ios::binary);
  if (!in) return fail("{}: {}; this program's user must be able to read it", file.string(), strerror(errno));
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

Bio bio_of(const std::string& text) {
  return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

std::string all_of(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return data == nullptr ? "" : std::string(data, static_cast<std::size_t>(size));
}

template <class Owner, class Read>
Result<Owner> read(const std::filesystem::path& file, const char* what, Read reader) {
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  Owner object(reader(bio_of(*text).get()));
  ERR_clear_error();
  if (!object) return fail("{} is no {}; copy it anew", file.string(), what);
  return object;
}

/// In place of a prompt at the terminal.
int no_password(char* /*buffer*/, int /*size*/, int /*writing*/, void* /*user*/) {
  return -1;
}

}  // namespace

Result<Certificate> read_certificate(const std::filesystem::path& file) {
  return read<Certificate>(file, "certificate (PEM)",
                           [](BIO* bio) { return PEM_read_bio_X509(bio, nullptr, no_password, nullptr); });
}

Result<RevocationList> read_revocation_list(const std::filesystem::path& file) {
  return read<RevocationList>(file, "revocation list (PEM)", [](BIO* bio) {
    return PEM_read_bio_X509_CRL(bio, nullptr, no_password, nullptr);
  });
}

Result<Key> read_key(const std::filesystem::path& file) {
  return read<Key>(file, "private key without a password (PEM)",
                   [](BIO* bio) { return PEM_read_bio_PrivateKey(bio, nullptr, no_password, nullptr); });
}

Result<std::string> read_signed(const std::filesystem::path& file, X509& signer) {
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  BIO* content = nullptr;
  const std::unique_ptr<PKCS7, Deleter<PKCS7_free>> document(SMIME_read_PKCS7(bio_of(*text).get(), &content));
  const Bio signed_content(content), out(BIO_new(BIO_s_mem()));
  const std::unique_ptr<X509_STORE, Deleter<X509_STORE_free>> store(X509_STORE_new());
  X509_STORE_add_cert(store.get(), &signer);
  const bool good = document && PKCS7_verify(document.get(), nullptr, store.get(), signed_content.get(),
                                             out.get(), PKCS7_TEXT) == 1;
  ERR_clear_error();
  if (!good) return fail("{} is not signed by permissions_ca.cert.pem, or was changed since", file.string());
  return all_of(out.get());
}

int verify(X509& certificate, X509& ca, X509_CRL& revoked) {
  const std::unique_ptr<X509_STORE, Deleter<X509_STORE_free>> store(X509_STORE_new());
  X509_STORE_add_cert(store.get(), &ca);
  X509_STORE_add_crl(store.get(), &revoked);
  const std::unique_ptr<X509_STORE_CTX, Deleter<X509_STORE_CTX_free>> context(X509_STORE_CTX_new());
  if (X509_STORE_CTX_init(context.get(), store.get(), &certificate, nullptr) != 1)
    return X509_V_ERR_UNSPECIFIED;
  X509_STORE_CTX_set_flags(context.get(), X509_V_FLAG_CRL_CHECK);
  const bool good = X509_verify_cert(context.get()) == 1;
  ERR_clear_error();
  return good ? X509_V_OK : X509_STORE_CTX_get_error(context.get());
}

std::string subject_part(const X509& certificate, int nid) {
  char text[128] = "";
  const X509_NAME* name = X509_get_subject_name(&certificate);
  return X509_NAME_get_text_by_NID(name, nid, text, sizeof text) > 0 ? text : "";
}

std::string subject(const X509& certificate) {
  const Bio out(BIO_new(BIO_s_mem()));
  X509_NAME_print_ex(out.get(), X509_get_subject_name(&certificate), 0, XN_FLAG_RFC2253);
  return all_of(out.get());
}

}  // namespace liloc::pem
