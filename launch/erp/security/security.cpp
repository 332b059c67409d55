#include "launch/erp/security/security.hpp"

#include <fcntl.h>
#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "components/node/clock.hpp"
#include "components/node/security.hpp"
#include "launch/erp/security/security_texts.hpp"

namespace launch {
namespace {

namespace fs = std::filesystem;
using Files = node::SecurityFiles;
using Bio = std::unique_ptr<BIO, decltype(&BIO_free)>;
using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;
using Signature = std::unique_ptr<PKCS7, decltype(&PKCS7_free)>;

void check(bool success, const char* operation) {
  if (!success) throw std::runtime_error(std::string("libcrypto cannot ") + operation);
}

struct Party {
  const char* name;
  Key key{EVP_EC_gen("prime256v1"), EVP_PKEY_free};  // the curve required by DDS Security
  Certificate certificate{X509_new(), X509_free};
};

void extend(X509* certificate, int kind, const char* value) {
  const std::unique_ptr<X509_EXTENSION, decltype(&X509_EXTENSION_free)> extension(
      X509V3_EXT_conf_nid(nullptr, nullptr, kind, value), X509_EXTENSION_free);
  check(extension && X509_add_ext(certificate, extension.get(), -1), "extend a certificate");
}

void set_random_serial(X509* certificate) {
  unsigned char bytes[16];
  check(RAND_bytes(bytes, sizeof bytes) == 1, "draw a random number");
  bytes[0] &= 0x7f;  // positive
  const std::unique_ptr<BIGNUM, decltype(&BN_free)> number(BN_bin2bn(bytes, sizeof bytes, nullptr),
                                                           BN_free);
  check(BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(certificate)),
        "set a serial number");
}

void add_name(X509_NAME* name_entry, const char* organisation, const char* name) {
  const auto add = [&](const char* field, const char* value) {
    const auto* text = reinterpret_cast<const unsigned char*>(value);
    check(X509_NAME_add_entry_by_txt(name_entry, field, MBSTRING_ASC, text, -1, -1, 0) == 1,
          "name a certificate");
  };
  add("O", organisation), add("CN", name);
}

/// Fills in the certificate of `subject` and signs it with the key of `issuer`.
void certify(Party& subject, const Party& issuer, const Validity& validity) {
  X509* certificate = subject.certificate.get();
  check(X509_set_version(certificate, X509_VERSION_3) == 1, "make a certificate");
  set_random_serial(certificate);
  check(ASN1_TIME_set(X509_getm_notBefore(certificate), validity.from_s) &&
            ASN1_TIME_set(X509_getm_notAfter(certificate), validity.until_s),
        "date a certificate");
  add_name(X509_get_subject_name(certificate), security_organisation, subject.name);
  check(X509_set_issuer_name(certificate, X509_get_subject_name(issuer.certificate.get())) == 1,
        "name an issuer");
  check(X509_set_pubkey(certificate, subject.key.get()) == 1, "certify a key");
  const bool is_authority = &subject == &issuer;
  extend(certificate, NID_basic_constraints,
         is_authority ? "critical,CA:TRUE" : "critical,CA:FALSE");
  extend(certificate, NID_key_usage,
         is_authority ? "critical,keyCertSign,digitalSignature"
                      : "critical,digitalSignature,keyAgreement");
  check(X509_sign(certificate, issuer.key.get(), EVP_sha256()) > 0, "sign a certificate");
}

/// Writes a document as S/MIME, the format required by DDS Security.
void write_signed(BIO* out, const std::string& text, const Party& issuer) {
  constexpr int flags = PKCS7_TEXT | PKCS7_DETACHED;
  const Bio in(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), BIO_free);
  const Signature signature(
      PKCS7_sign(issuer.certificate.get(), issuer.key.get(), nullptr, in.get(), flags), PKCS7_free);
  check(signature && BIO_reset(in.get()) == 1 &&
            SMIME_write_PKCS7(out, signature.get(), in.get(), flags) == 1,
        "sign a document");
}

/// Creates a new folder and files in it. Does not overwrite existing files.
class Writer {
 public:
  explicit Writer(fs::path folder) : folder_(std::move(folder)) {
    if (fs::exists(folder_) && !(fs::is_directory(folder_) && fs::is_empty(folder_)))
      throw std::invalid_argument(folder_.string() + " exists already; name a new folder");
    std::error_code error;
    fs::create_directories(folder_, error);
    if (!error) fs::permissions(folder_, fs::perms::owner_all, error);
    if (error) throw std::runtime_error(folder_.string() + ": " + error.message());
  }
  template <class Write>
  void write(const char* name, mode_t mode, Write&& write_into) {
    const fs::path file = folder_ / name;
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor < 0) throw std::runtime_error(file.string() + ": " + std::strerror(errno));
    const Bio out(BIO_new_fd(descriptor, BIO_CLOSE), BIO_free);
    write_into(out.get());
    files_.push_back(file);
  }
  void write_certificate(const char* name, const Party& party) {
    write(name, 0644, [&](BIO* out) {
      check(PEM_write_bio_X509(out, party.certificate.get()) == 1, "write a certificate");
    });
  }
  void write(const char* certificate, const char* key, const Party& party) {
    write_certificate(certificate, party);
    write(key, 0600, [&](BIO* out) {
      check(PEM_write_bio_PrivateKey(out, party.key.get(), nullptr, nullptr, 0, nullptr, nullptr) ==
                1,
            "write a key");
    });
  }
  const std::vector<fs::path>& files() const { return files_; }

 private:
  fs::path folder_;
  std::vector<fs::path> files_;
};

constexpr std::int64_t day_s = 86400;

}  // namespace

Validity valid_for_days(int days) {
  const std::int64_t now_s = node::wall_ns() / 1'000'000'000;
  return {now_s - day_s, now_s + days * day_s};
}

namespace {

void write_identity(Writer& writer, const SecurityRole& role, const Party& authority,
                    const Validity& validity) {
  Party identity{.name = role.name};
  check(bool(identity.key), "make a key");
  certify(identity, authority, validity);
  writer.write(Files::identity, Files::identity_key, identity);
  writer.write(Files::governance, 0644,
               [&](BIO* out) { write_signed(out, governance_text(), authority); });
  writer.write(Files::permissions, 0644,
               [&](BIO* out) { write_signed(out, permissions_text(validity, role), authority); });
}

}  // namespace

std::vector<fs::path> make_security(const fs::path& folder, const Validity& validity) {
  Party authority{.name = "authority"};
  check(bool(authority.key), "make a key");
  certify(authority, authority, validity);
  Writer writer(folder);
  writer.write(Files::authority, Files::authority_key, authority);
  write_identity(writer, operator_role(), authority, validity);
  std::vector<fs::path> files = writer.files();
  for (const SecurityRole& role : component_roles()) {
    Writer of_role(folder / Files::roles / role.name);
    of_role.write_certificate(Files::authority, authority);
    write_identity(of_role, role, authority, validity);
    files.insert(files.end(), of_role.files().begin(), of_role.files().end());
  }
  return files;
}

}  // namespace launch
