#pragma once
#include <string>
#include <vector>

#include "launch/erp/security/security.hpp"

/// The two documents that the certificate authority signs (DDS Security 1.1, chapter 9.4).
namespace launch {

inline constexpr const char* security_organisation = "erp";

/// An identity and the topics that it may write. Every identity may read all topics.
struct SecurityRole {
  const char* name;
  std::vector<const char*> topics;  ///< names or patterns of fnmatch(3); empty: none
};

/// The identity of the folder itself: the launcher and the verbs, also gains.
SecurityRole operator_role();
/// The identities in its subfolder `roles`: of the components of a graph, and of a listener, which
/// writes nothing.
std::vector<SecurityRole> component_roles();

/// Governance: only participants with a certificate; discovery, liveliness and all messages
/// encrypted.
std::string governance_text();

/// Permissions of the holder of the role's certificate.
std::string permissions_text(const Validity& validity, const SecurityRole& role);

}  // namespace launch
