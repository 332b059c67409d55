#pragma once
#include <string>

/// Who may be on the bus. With ERP_SECURITY=FOLDER only processes that hold a certificate of the
/// robot's own authority are heard, and what they say is encrypted; `erp security make FOLDER`
/// writes the folder.
namespace node {

/// What such a folder holds.
struct SecurityFiles {
  static constexpr const char* authority = "authority.pem";      ///< of identities and permissions
  static constexpr const char* authority_key = "authority.key";  ///< not needed to run
  static constexpr const char* identity = "identity.pem";
  static constexpr const char* identity_key = "identity.key";
  static constexpr const char* governance = "governance.p7s";    ///< what is protected, and how
  static constexpr const char* permissions = "permissions.p7s";  ///< who may say and hear what
};

/// The folder that ERP_SECURITY names, absolute; "" when it is not set.
/// Throws std::invalid_argument when it is set, but to nothing.
std::string security_folder();

/// Cyclone's configuration for that folder; "" without one. Throws std::invalid_argument with
/// place, value and remedy for what is missing, out of date, of another authority, or open to
/// others: who asks for protection never runs without it.
std::string security_config();

/// When its identity expires, in words; "" without one. DDS then ends all that the process says
/// and hears, also in mid-run.
std::string security_expires();

}  // namespace node
