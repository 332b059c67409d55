#pragma once
#include <string>

#include "launch/erp/security/security.hpp"

/// The two documents of DDS Security 1.1 that the authority signs, chapter 9.4.
namespace launch {

inline constexpr const char* security_organisation = "erp";
inline constexpr const char* security_identity = "robot";

/// What is protected, and how: nobody without a certificate, discovery, liveliness and every
/// message encrypted.
std::string governance_text();

/// Whom the certificate names may say and hear everything.
std::string permissions_text(const Validity& validity);

}  // namespace launch
