#pragma once
#include <string>

#include "launch/erp/security/security.hpp"

/// The two documents that the certificate authority signs (DDS Security 1.1, chapter 9.4).
namespace launch {

inline constexpr const char* security_organisation = "erp";
inline constexpr const char* security_identity = "robot";

/// Governance: only participants with a certificate; discovery, liveliness and all messages
/// encrypted.
std::string governance_text();

/// Permissions: the holder of the certificate may publish and subscribe to every topic.
std::string permissions_text(const Validity& validity);

}  // namespace launch
