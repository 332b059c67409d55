#include "components/node/raw.hpp"

#include <dds/ddsi/ddsi_serdata.h>

#include <algorithm>
#include <cstring>

#include "components/node/builtin.hpp"
#include "components/node/peer.hpp"

namespace node {
namespace {

constexpr dds_duration_t type_timeout = DDS_MSECS(200);

/// The descriptor of a message of this project, null for any other type. Cyclone 0.10 cannot
/// create these from their type information, because their key is a bounded string ("Unsupported").
template <class... M>
const dds_topic_descriptor_t* project_type(const std::string& name, std::tuple<M...>*) {
  const dds_topic_descriptor_t* type = nullptr;
  ((name == erp::Topic<M>::type->m_typename ? type = erp::Topic<M>::type : nullptr), ...);
  return type;
}

}  // namespace

Discovery::Discovery(const Entity& participant, Wake& wake)
    : participant_(participant),
      callback_(wake_callback(wake)),
      participants_(make_builtin_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, callback_)),
      writers_(make_builtin_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, callback_)),
      readers_(make_builtin_reader(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, callback_)) {}

std::string Discovery::participant_name(const dds_guid_t& key) {
  std::string name;
  for_each_alive<dds_builtintopic_participant_t>(participants_, [&](const auto& p, const auto&) {
    if (std::memcmp(&p.key, &key, sizeof key) == 0) name = parse_peer(user_data(p.qos)).component;
  });
  return name;
}

std::vector<Endpoint> Discovery::endpoints() {
  std::vector<Endpoint> endpoints;
  for (const auto* reader : {&writers_, &readers_})
    for_each_alive<dds_builtintopic_endpoint_t>(*reader, [&](const auto& e, const auto& info) {
      if (std::strncmp(e.topic_name, "DCPS", 4) == 0) return;
      endpoints.push_back({e.topic_name, e.type_name, participant_name(e.participant_key),
                           reader == &writers_, info.instance_handle});
    });
  return endpoints;
}

Descriptor Discovery::type_of(const std::string& topic) {
  Descriptor type;
  for (const auto* reader : {&writers_, &readers_})
    for_each_alive<dds_builtintopic_endpoint_t>(*reader, [&](auto& e, const auto&) {
      if (type || topic != e.topic_name) return;
      if (const auto* known_type =
              project_type(e.type_name, static_cast<erp::Messages*>(nullptr))) {
        type = Descriptor(known_type, [](const dds_topic_descriptor_t*) {});
        return;
      }
      const dds_typeinfo_t* type_info = nullptr;
      if (dds_builtintopic_get_endpoint_type_info(&e, &type_info) != DDS_RETCODE_OK || !type_info)
        return;
      dds_topic_descriptor_t* descriptor = nullptr;
      if (dds_create_topic_descriptor(DDS_FIND_SCOPE_GLOBAL, participant_.id(), type_info,
                                      type_timeout, &descriptor) == DDS_RETCODE_OK)
        type = Descriptor(descriptor, [](const dds_topic_descriptor_t* d) {
          dds_delete_topic_descriptor(const_cast<dds_topic_descriptor_t*>(d));
        });
    });
  return type;
}

RawReader::RawReader(const Entity& participant, Wake& wake, const dds_topic_descriptor_t& type,
                     const std::string& topic, int depth, const std::string& robot)
    : callback_(std::make_unique<DataCallback>(wake_callback(wake))),
      robot_(std::make_unique<const std::string>(robot)),
      topic_(make_topic(participant, type, topic.c_str(), *robot_)),
      reader_(make_reader(participant, topic_, depth, *callback_)) {}

std::optional<RawSample> RawReader::next() {
  ddsi_serdata* data = nullptr;
  dds_sample_info_t info;
  while (dds_takecdr(reader_.id(), &data, 1, &info, DDS_ANY_STATE) == 1) {
    if (info.valid_data) {
      bytes_.resize(ddsi_serdata_size(data));
      ddsi_serdata_to_ser(data, 0, bytes_.size(), bytes_.data());
    }
    ddsi_serdata_unref(data);
    if (info.valid_data) return RawSample{bytes_, info.source_timestamp, info.publication_handle};
  }
  return std::nullopt;
}

std::uint32_t RawReader::matched() const {
  const auto n = dds_get_matched_publications(reader_.id(), nullptr, 0);
  return n > 0 ? static_cast<std::uint32_t>(n) : 0;
}

std::uint64_t RawReader::lost() const {
  dds_sample_lost_status_t status{};
  return dds_get_sample_lost_status(reader_.id(), &status) == DDS_RETCODE_OK ? status.total_count
                                                                             : 0;
}

}  // namespace node
