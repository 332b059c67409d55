#pragma once
#include <filesystem>
#include <string>
#include <vector>

/// `erp security make DIR`: certificates by which the processes of a robot authenticate each other.
namespace launch {

/// Validity of the certificates, in seconds since 1970.
struct Validity {
  std::int64_t from_s = 0, until_s = 0;
};
/// From one day ago until `days` days from now. The day in the past is for machines with a slow
/// clock.
Validity valid_for_days(int days);

/// Writes to `folder` a certificate authority, an identity with a certificate issued by it, and the
/// signed governance and permissions documents; in its subfolder `roles` the same for each role of a
/// component, with its own permissions (security_texts.hpp). `folder` must be empty or must not exist. Returns
/// the files. Only their owner can read the keys. Throws std::invalid_argument for a folder that is
/// not empty, std::runtime_error if a file cannot be written.
std::vector<std::filesystem::path> make_security(const std::filesystem::path& folder,
                                                 const Validity& validity);

}  // namespace launch
