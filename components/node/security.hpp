#pragma once
#include <string>

/// DDS Security. With ERP_SECURITY=FOLDER only processes with a certificate of the robot's own
/// authority can exchange messages, and all messages are encrypted. `erp security make FOLDER`
/// writes the folder.
namespace node {

/// The files of a security folder.
struct SecurityFiles {
  static constexpr const char* authority = "authority.pem";  ///< CA of identities and permissions
  static constexpr const char* authority_key = "authority.key";  ///< not needed to run
  static constexpr const char* identity = "identity.pem";
  static constexpr const char* identity_key = "identity.key";
  static constexpr const char* governance = "governance.p7s";  ///< which data is protected, and how
  static constexpr const char* permissions =
      "permissions.p7s";                         ///< who may publish and subscribe to what
  static constexpr const char* roles = "roles";  ///< subfolder with one security folder per role
};

/// The absolute path of the folder in ERP_SECURITY; "" when the variable is not set.
/// Throws std::invalid_argument when it is set to an empty string.
std::string security_folder();

/// The folder with the identity of one role, inside that folder; the folder itself if it has none,
/// because it was written by version 0.1.
std::string security_folder_of(const std::string& role);

/// Cyclone's configuration for that folder; "" without one. Throws std::invalid_argument with
/// place, value and remedy if a file is missing, expired, of another authority, or a key is
/// accessible to other users. A process with ERP_SECURITY set never runs without protection.
std::string security_config();

/// Expiry date of the identity certificate, as text; "" without a folder. At that time DDS ends all
/// communication of the process, also during a run.
std::string security_expires();

}  // namespace node
