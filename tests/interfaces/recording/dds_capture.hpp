#pragma once
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "interfaces/recording/bytes.hpp"

/// Serializes messages with Cyclone DDS: writes and takes them in one process, in a separate domain
/// on loopback.
namespace test {

class Capture {
 public:
  explicit Capture(dds_domainid_t id = 77) : domain_(dds_create_domain(id, config)) {
    participant_ = dds_create_participant(id, nullptr, nullptr);
    if (domain_ < 0 || participant_ < 0) throw std::runtime_error("cannot open a DDS domain");
  }
  ~Capture() { dds_delete(domain_); }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  /// The bytes of `sample` (the C struct) on the wire, encapsulation first.
  recording::Bytes bytes_of(const dds_topic_descriptor_t& type, const void* sample) {
    std::string name = type.m_typename;  // a topic name must not contain ::
    std::replace(name.begin(), name.end(), ':', '_');
    const dds_entity_t topic =
        checked(dds_create_topic(participant_, &type, name.c_str(), nullptr, nullptr));
    const dds_entity_t reader = checked(dds_create_reader(participant_, topic, nullptr, nullptr));
    const dds_entity_t writer = checked(dds_create_writer(participant_, topic, nullptr, nullptr));
    checked(dds_write(writer, sample));
    ddsi_serdata* serialized = nullptr;
    dds_sample_info_t info;
    if (dds_takecdr(reader, &serialized, 1, &info, DDS_ANY_STATE) != 1)
      throw std::runtime_error(std::string(type.m_typename) + " did not come back");
    recording::Bytes bytes(ddsi_serdata_size(serialized));
    ddsi_serdata_to_ser(serialized, 0, bytes.size(), bytes.data());
    ddsi_serdata_unref(serialized);
    for (const dds_entity_t entity : {reader, writer, topic}) dds_delete(entity);
    return bytes;
  }
  dds_entity_t participant() const { return participant_; }

  static constexpr const char* config =
      "<CycloneDDS><Domain Id='any'><General><Interfaces><NetworkInterface name='lo' "
      "multicast='false'/></Interfaces><AllowMulticast>false</AllowMulticast></General>"
      "<Discovery><ParticipantIndex>auto</ParticipantIndex><ExternalDomainId>177</ExternalDomainId>"
      "<MaxAutoParticipantIndex>60</MaxAutoParticipantIndex><Peers><Peer Address='127.0.0.1'/>"
      "</Peers></Discovery></Domain></CycloneDDS>";

 private:
  static dds_return_t checked(dds_return_t rc) {
    if (rc < 0) throw std::runtime_error(dds_strretcode(-rc));
    return rc;
  }
  dds_entity_t domain_, participant_;
};

}  // namespace test
