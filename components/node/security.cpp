#include "components/node/security.hpp"

#include <dds/dds.h>
#include <dlfcn.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "interfaces/xml/writer.hpp"

namespace node {
namespace {

namespace fs = std::filesystem;
using Files = SecurityFiles;
using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;
using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using Bio = std::unique_ptr<BIO, decltype(&BIO_free)>;

constexpr auto remake_folder =
    "write a new folder with erp security make, for all of this robot's machines";

[[noreturn]] void refuse(const fs::path& place, const std::string& problem,
                         const std::string& remedy) {
  throw std::invalid_argument(place.string() + ": " + problem + "; " + remedy);
}

void check_files(const fs::path& folder) {
  if (!fs::is_directory(folder))
    refuse("ERP_SECURITY=" + folder.string(), "no such folder",
           "erp security make " + folder.string() + " writes one");
  for (const auto* name : {Files::authority, Files::identity, Files::identity_key,
                           Files::governance, Files::permissions}) {
    const fs::path file = folder / name;
    if (!fs::exists(file)) refuse(file, "is missing", remake_folder);
    if (!std::ifstream(file)) refuse(file, "cannot be read", "run as its owner");
  }
}

/// Anyone who can write to the folder, or owns it, can replace its keys and documents.
void check_folder(const fs::path& folder) {
  struct stat status {};
  if (stat(folder.c_str(), &status) != 0) return;  // check_files reports it
  if (status.st_uid != geteuid() && status.st_uid != 0)
    refuse(folder, "belongs to another user, number " + std::to_string(status.st_uid),
           "run as that user, or give it to this one: chown -R " + std::to_string(geteuid()) + " " +
               folder.string());
  if (!(status.st_mode & 022)) return;
  std::ostringstream mode;
  mode << "can be changed by other users, mode 0" << std::oct << (status.st_mode & 0777);
  refuse(folder, mode.str(), "chmod 700 " + folder.string());
}

/// Anyone who can read a key can impersonate its owner.
void check_key_permissions(const fs::path& key) {
  struct stat status {};
  if (stat(key.c_str(), &status) != 0 || !(status.st_mode & 077)) return;
  std::ostringstream mode;
  mode << "is accessible to other users, mode 0" << std::oct << (status.st_mode & 0777);
  refuse(key, mode.str(), "chmod 600 " + key.string());
}

Certificate certificate_of(const fs::path& file) {
  const Bio text(BIO_new_file(file.c_str(), "r"), BIO_free);
  Certificate certificate(PEM_read_bio_X509(text.get(), nullptr, nullptr, nullptr), X509_free);
  if (!certificate) refuse(file, "contains no certificate", remake_folder);
  return certificate;
}

std::string text_of(const ASN1_TIME* time) {
  const Bio out(BIO_new(BIO_s_mem()), BIO_free);
  ASN1_TIME_print(out.get(), time);
  char* text = nullptr;
  const long size = BIO_get_mem_data(out.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

void check_validity_period(const fs::path& file, const X509* certificate) {
  const ASN1_TIME *from = X509_get0_notBefore(certificate),
                  *until = X509_get0_notAfter(certificate);
  if (X509_cmp_current_time(until) <= 0)
    refuse(file, "expired on " + text_of(until), remake_folder);
  if (X509_cmp_current_time(from) > 0)
    refuse(file, "is not valid before " + text_of(from), "set the clock of this machine");
}

void check_certificates(const fs::path& folder) {
  const auto authority = certificate_of(folder / Files::authority);
  const auto identity = certificate_of(folder / Files::identity);
  check_validity_period(folder / Files::authority, authority.get());
  check_validity_period(folder / Files::identity, identity.get());
  if (X509_verify(identity.get(), X509_get0_pubkey(authority.get())) != 1)
    refuse(folder / Files::identity, "was not issued by the authority in this folder",
           remake_folder);
  const fs::path key_file = folder / Files::identity_key;
  const Bio text(BIO_new_file(key_file.c_str(), "r"), BIO_free);
  const Key key(PEM_read_bio_PrivateKey(text.get(), nullptr, nullptr, nullptr), EVP_PKEY_free);
  if (!key || X509_check_private_key(identity.get(), key.get()) != 1)
    refuse(key_file, "is not the key of " + std::string(Files::identity), remake_folder);
}

/// Cyclone's plugins are in the folder of its library or, on Debian, in a subfolder of it.
std::string plugin(const std::string& name) {
  Dl_info library{};
  dladdr(reinterpret_cast<const void*>(&dds_create_domain), &library);
  const fs::path folder_of_library =
      fs::path(library.dli_fname ? library.dli_fname : "").parent_path();
  const std::string file = "libdds_security_" + name + ".so";
  for (const auto& folder : {folder_of_library / "libddsc0debian", folder_of_library})
    if (fs::exists(folder / file)) return folder / file;
  refuse(folder_of_library / file, "Cyclone DDS's security plugin is missing",
         "install Debian's libddsc0debian");
}

std::string library(const std::string& name, const std::string& function) {
  return "<Library path=\"" + xml::escaped(plugin(name)) + "\" initFunction=\"init_" + function +
         "\" finalizeFunction=\"finalize_" + function + "\"/>";
}

}  // namespace

std::string security_folder() {
  const char* value = std::getenv("ERP_SECURITY");
  if (!value) return "";
  if (!*value) throw std::invalid_argument("ERP_SECURITY is empty; name a folder, or unset it");
  return fs::absolute(value).lexically_normal();
}

std::string security_folder_of(const std::string& role) {
  const fs::path folder = security_folder();
  const fs::path of_role = folder / Files::roles / role;
  return fs::is_directory(of_role) ? of_role : folder;
}

std::string security_config() {
  const fs::path folder = security_folder();
  if (folder.empty()) return "";
  check_files(folder);
  check_folder(folder);
  for (const auto* key : {Files::identity_key, Files::authority_key})
    check_key_permissions(folder / key);
  check_certificates(folder);
  const auto file = [&](const std::string& element, const char* name) {
    return "<" + element + ">file:" + xml::escaped(folder / name) + "</" + element + ">";
  };
  return "<CycloneDDS><Domain Id=\"any\"><Security><Authentication>" +
         library("auth", "authentication") + file("IdentityCertificate", Files::identity) +
         file("IdentityCA", Files::authority) + file("PrivateKey", Files::identity_key) +
         "</Authentication><Cryptographic>" + library("crypto", "crypto") +
         "</Cryptographic><AccessControl>" + library("ac", "access_control") +
         file("PermissionsCA", Files::authority) + file("Governance", Files::governance) +
         file("Permissions", Files::permissions) +
         "</AccessControl></Security></Domain></CycloneDDS>";
}

std::string security_expires() {
  const fs::path folder = security_folder();
  if (folder.empty()) return "";
  return text_of(X509_get0_notAfter(certificate_of(folder / Files::identity).get()));
}

}  // namespace node
