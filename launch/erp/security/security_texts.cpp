#include "launch/erp/security/security_texts.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "interfaces/topics.hpp"

namespace launch {
namespace {

constexpr auto header = R"(<?xml version="1.0" encoding="utf-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_{}.xsd">
)";

// the range of ERP_DOMAIN
constexpr auto domains = "<domains><id_range><min>0</min><max>230</max></id_range></domains>";

// Metadata protection encrypts complete submessages including their data: data protection is not
// needed.
constexpr auto rule = R"(
  <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
  <enable_join_access_control>true</enable_join_access_control>
  <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
  <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
  <rtps_protection_kind>NONE</rtps_protection_kind>
  <topic_access_rules><topic_rule>
    <topic_expression>*</topic_expression>
    <enable_discovery_protection>true</enable_discovery_protection>
    <enable_liveliness_protection>true</enable_liveliness_protection>
    <enable_read_access_control>true</enable_read_access_control>
    <enable_write_access_control>true</enable_write_access_control>
    <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
    <data_protection_kind>NONE</data_protection_kind>
  </topic_rule></topic_access_rules>)";

std::string utc(std::int64_t time_s) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(static_cast<std::time_t>(time_s)));
}

using Topics = std::vector<const char*>;

std::string allow(const char* action, const Topics& topics) {
  if (topics.empty()) return "";
  std::string listed;
  for (const char* topic : topics) listed += fmt::format("<topic>{}</topic>", topic);
  return fmt::format(
      "<allow_rule>{1}<{0}><topics>{2}</topics>"
      "<partitions><partition>*</partition></partitions></{0}></allow_rule>\n",
      action, domains, listed);
}

template <class M>
constexpr const char* topic = erp::Topic<M>::name;

}  // namespace

SecurityRole operator_role() { return {"robot", {"*"}}; }

/// There are no deny rules: Cyclone 0.10 applies one against publishing to reading as well.
std::vector<SecurityRole> component_roles() {
  const char* const state = topic<erp::ComponentState>;
  const char* const event = topic<erp::Event>;
  return {
      {"plant",
       {topic<erp::SensorFrame>, topic<erp::EcuCommand>, topic<erp::EcuParameter>,
        topic<erp::ActuatorOwner>, state, event}},
      {"device",
       {topic<erp::EcuFrame>, topic<erp::Clock>, topic<erp::JointState>, topic<erp::BodyPose>,
        topic<erp::ImuFrame>, state, event}},
      {"controller",
       {topic<erp::ActuatorCommand>, topic<erp::ActuatorTarget>, topic<erp::JointTarget>,
        topic<erp::JointState>, topic<erp::BodyPose>, topic<erp::ImuFrame>, topic<erp::ImagePoint>,
        topic<erp::StageResidual>, state, event, "user_*", "rt/*"}},
      {"logger", {state, event}},
      {"listener", {}},
  };
}

std::string governance_text() {
  return fmt::format(fmt::runtime(header), "governance") + "<domain_access_rules><domain_rule>" +
         domains + rule + "\n</domain_rule></domain_access_rules></dds>\n";
}

std::string permissions_text(const Validity& validity, const SecurityRole& role) {
  return fmt::format(fmt::runtime(header), "permissions") +
         fmt::format(
             "<permissions><grant name=\"role\"><subject_name>CN={},O={}</subject_name>\n"
             "<validity><not_before>{}</not_before><not_after>{}</not_after></validity>\n{}{}"
             "<default>DENY</default></grant></permissions></dds>\n",
             role.name, security_organisation, utc(validity.from_s), utc(validity.until_s),
             allow("publish", role.topics), allow("subscribe", {"*"}));
}

}  // namespace launch
