#include "components/node/bus.hpp"

#include <atomic>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "components/node/security.hpp"

namespace node {
namespace {

// Loopback without multicast: participants find each other by unicast to 127.0.0.1, so every
// process needs a port of its own (index auto) and the highest index must cover a large graph.
// WhcHigh: a writer that keeps lockstep_depth messages of 54 actuators is never blocked.
constexpr const char* loopback = R"(<CycloneDDS><Domain Id="any">
  <General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
    <AllowMulticast>false</AllowMulticast></General>
  <Discovery><ParticipantIndex>auto</ParticipantIndex>
    <MaxAutoParticipantIndex>100</MaxAutoParticipantIndex>
    <Peers><Peer Address="127.0.0.1"/></Peers>
    <LeaseDuration>3s</LeaseDuration></Discovery>
  <Sizing><ReceiveBufferSize>128 kB</ReceiveBufferSize>
    <ReceiveBufferChunkSize>64 kB</ReceiveBufferChunkSize></Sizing>
  <Internal><Watermarks><WhcHigh>64 MB</WhcHigh><WhcAdaptive>false</WhcAdaptive></Watermarks></Internal>
</Domain></CycloneDDS>)";

dds_domainid_t domain_id() {
  const char* text = std::getenv("ERP_DOMAIN");
  if (!text || !*text) return 0;
  char* end = nullptr;
  const long id = std::strtol(text, &end, 10);
  if (*end || id < 0 || id > 230)
    throw std::invalid_argument(std::string("ERP_DOMAIN must be 0 … 230, got \"") + text + "\"");
  return static_cast<dds_domainid_t>(id);
}

/// Creates the domain once per process. The configuration is CYCLONEDDS_URI if set, else the
/// loopback configuration; ERP_SECURITY adds the security configuration.
void open_domain(dds_domainid_t id) {
  const char* user_config = std::getenv("CYCLONEDDS_URI");
  const std::string security = security_config();
  if (user_config && security.empty()) return;
  std::string config = user_config ? user_config : loopback;
  // Cyclone uses the first security element, so the user's configuration cannot replace this one.
  if (!security.empty()) config = security + "," + config;
  static const Entity domain(dds_create_domain(id, config.c_str()), "open DDS domain");
}

/// Throws when DDS did not create the participant because it rejects a certificate or document of
/// the security folder.
dds_entity_t check_security(dds_entity_t participant) {
  const std::string folder = security_folder();
  if (participant >= 0 || folder.empty()) return participant;
  throw std::invalid_argument("ERP_SECURITY=" + folder + ": DDS refuses it (" +
                              dds_strretcode(-participant) +
                              "); write a new folder with erp security make");
}

using OwnedQos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

OwnedQos qos_with(const Peer& self) {
  OwnedQos qos(dds_create_qos(), dds_delete_qos);
  const std::string data = to_user_data(self);
  dds_qset_userdata(qos.get(), data.data(), data.size());
  return qos;
}

/// These counters order memory for the thread sanitizer: writes before a listener is attached
/// happen before its callback, and the callback happens before the deletion of its reader returns.
/// DDS's own locks ensure this order too, but the sanitizer cannot observe them.
std::atomic<unsigned> attached = 0, handled = 0;

void on_data(dds_entity_t, void* data_callback) {
  attached.load(std::memory_order_acquire);
  const auto& callback = *static_cast<const DataCallback*>(data_callback);
  callback.function(callback.context);
  handled.fetch_add(1, std::memory_order_release);
}

}  // namespace

Entity::Entity(dds_entity_t id, const char* operation) : id_(id) {
  if (id < 0) throw std::runtime_error(std::string(operation) + ": " + dds_strretcode(-id));
}

Entity::~Entity() {
  if (id_ <= 0) return;
  dds_delete(id_);  // waits for running listeners
  handled.load(std::memory_order_acquire);
}

const char* loopback_config() { return loopback; }

Entity join(const std::string& name) { return join(own_peer(name, "")); }

Entity join(const Peer& self) {
  const dds_domainid_t id = domain_id();
  open_domain(id);
  return {check_security(dds_create_participant(id, qos_with(self).get(), nullptr)),
          "join the bus"};
}

void announce(const Entity& participant, const Peer& self) {
  if (const auto rc = dds_set_qos(participant.id(), qos_with(self).get()); rc < 0)
    throw std::runtime_error(std::string("announce ") + self.component + ": " +
                             dds_strretcode(-rc));
}

Qos::Qos(int depth) : qos(dds_create_qos()) {
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
}
Qos::~Qos() { dds_delete_qos(qos); }

namespace {

/// Every message of this project begins with the name of its robot.
bool is_of_robot(const void* message, void* robot) {
  return *static_cast<const std::string*>(robot) == static_cast<const char*>(message);
}

}  // namespace

Entity make_topic(const Entity& participant, const dds_topic_descriptor_t& type, const char* name,
                  const std::string& robot) {
  Entity topic(dds_create_topic(participant.id(), &type, name, nullptr, nullptr), name);
  if (robot.empty()) return topic;
  auto* argument = const_cast<std::string*>(&robot);
  if (const auto rc = dds_set_topic_filter_and_arg(topic.id(), is_of_robot, argument); rc < 0)
    throw std::runtime_error(std::string("filter ") + name + ": " + dds_strretcode(-rc));
  return topic;
}

Entity make_writer(const Entity& participant, const Entity& topic, int depth) {
  const Qos qos(depth);
  const dds_entity_t writer = dds_create_writer(participant.id(), topic.id(), qos.qos, nullptr);
  if (writer == DDS_RETCODE_NOT_ALLOWED_BY_SECURITY) {
    char name[256] = "";
    dds_get_name(topic.id(), name, sizeof name);
    throw std::invalid_argument("ERP_SECURITY=" + security_folder() +
                                ": its identity may not write " + name +
                                "; use the folder of a role that may, or the one above roles");
  }
  return {writer, "create writer"};
}

DataCallback wake_callback(Wake& wake) {
  return {[](void* context) { static_cast<Wake*>(context)->raise(); }, &wake};
}

namespace {

Entity attach(const Entity& participant, dds_entity_t topic, const dds_qos_t* qos,
              const DataCallback& callback) {
  const std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)> listener(
      dds_create_listener(const_cast<DataCallback*>(&callback)), dds_delete_listener);
  dds_lset_data_available(listener.get(), on_data);
  attached.fetch_add(1, std::memory_order_release);
  return {dds_create_reader(participant.id(), topic, qos, listener.get()), "create reader"};
}

}  // namespace

Entity make_reader(const Entity& participant, const Entity& topic, int depth,
                   const DataCallback& callback) {
  return attach(participant, topic.id(), Qos(depth).qos, callback);
}

Entity make_builtin_reader(const Entity& participant, dds_entity_t topic,
                           const DataCallback& callback) {
  return attach(participant, topic, nullptr, callback);
}

}  // namespace node
