#pragma once
#include <dds/dds.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "components/node/peer.hpp"
#include "components/node/wake.hpp"
#include "interfaces/topics.hpp"

/// Wrapper of Cyclone DDS: owned entities, typed writers and readers.
namespace node {

/// Owns one Cyclone DDS entity. Throws std::runtime_error with the operation's name when DDS
/// refuses.
class Entity {
 public:
  Entity() = default;
  Entity(dds_entity_t id, const char* operation);
  Entity(Entity&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Entity& operator=(Entity&& other) noexcept { return std::swap(id_, other.id_), *this; }
  ~Entity();
  dds_entity_t id() const { return id_; }

 private:
  dds_entity_t id_ = 0;
};

/// Creates a participant whose user data contains `self`; other participants can read it.
/// Without CYCLONEDDS_URI the bus is this machine's loopback; ERP_DOMAIN (0…230) separates graphs.
Entity join(const Peer& self);
/// Replaces the user data of a participant.
void announce(const Entity& participant, const Peer& self);
/// Joins as a tool that belongs to no robot.
Entity join(const std::string& name);

/// The Cyclone DDS configuration of the loopback bus, for other tools that join it.
const char* loopback_config();

/// QoS of every topic: reliable, volatile, keep the last `depth` samples per key.
struct Qos {
  explicit Qos(int depth = 1);
  ~Qos();
  dds_qos_t* qos;
};

/// With a `robot`, the topic's readers receive only messages of this robot: DDS stores nothing for
/// others, whatever their names. `type` must then be a message of this project, and `robot` must
/// outlive the topic.
Entity make_topic(const Entity& participant, const dds_topic_descriptor_t& type, const char* name,
                  const std::string& robot = {});
Entity make_writer(const Entity& participant, const Entity& topic, int depth);

/// Messages that a writer keeps in lockstep for readers that have not received them. A run in
/// lockstep is faster than real time and can overflow the socket of a reader on a busy machine.
/// Chosen: 2 s at 2500 messages per second. In real time a writer keeps the newest message.
inline constexpr int lockstep_depth = 5000;

/// Function that DDS's thread calls when samples are available.
struct DataCallback {
  void (*function)(void* context);
  void* context;
};
/// A callback that only raises `wake`; the main loop then takes the samples.
DataCallback wake_callback(Wake& wake);
/// The listener is attached at creation, so no sample is missed. `callback` must outlive the
/// reader.
Entity make_reader(const Entity& participant, const Entity& topic, int depth,
                   const DataCallback& callback);
/// The same for one of DDS's built-in topics.
Entity make_builtin_reader(const Entity& participant, dds_entity_t topic,
                           const DataCallback& callback);

/// Publishes messages of one type.
template <class M>
class Writer {
 public:
  explicit Writer(const Entity& participant, int depth = 1)
      : topic_(make_topic(participant, *erp::Topic<M>::type, erp::Topic<M>::name)),
        writer_(make_writer(participant, topic_, depth)) {}

  /// Assigns the next sequence number and sends the message. Throws std::runtime_error when DDS
  /// refuses it.
  void write(M& message) {
    message.sequence = sequence_++;
    send(message);
  }
  /// Sends the message with its own sequence number; its stamp is also the DDS source timestamp.
  /// If slow readers leave DDS no room for the message within one second, it is not sent. Every
  /// reader then counts it as missing.
  void send(const M& message) {
    const dds_return_t rc = dds_write_ts(
        writer_.id(), static_cast<const typename M::Wire*>(&message), message.stamp_ns);
    if (rc < 0 && rc != DDS_RETCODE_TIMEOUT)
      throw std::runtime_error(std::string("write ") + erp::Topic<M>::name + ": " +
                               dds_strretcode(-rc));
  }
  std::uint32_t matched() const {
    const dds_return_t n = dds_get_matched_subscriptions(writer_.id(), nullptr, 0);
    return n > 0 ? static_cast<std::uint32_t>(n) : 0;
  }

 private:
  Entity topic_, writer_;
  std::uint64_t sequence_ = 0;
};

/// Takes messages of one type; counts missing sequence numbers.
template <class M>
class Reader {
  static_assert(offsetof(typename M::Wire, robot) == 0, "make_topic compares the first member");

 public:
  /// `robot`: the robot whose messages are received; empty: every robot.
  Reader(const Entity& participant, Wake& wake, int depth = erp::Topic<M>::depth,
         const std::string& robot = "")
      : Reader(participant, wake_callback(wake), depth, robot) {}
  Reader(const Entity& participant, const DataCallback& callback, int depth = erp::Topic<M>::depth,
         const std::string& robot = "")
      : callback_(callback),
        robot_(robot),
        topic_(make_topic(participant, *erp::Topic<M>::type, erp::Topic<M>::name, robot_)),
        reader_(make_reader(participant, topic_, depth, callback_)) {}
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Passes every available sample to `handle`, oldest first, without heap allocation. True if
  /// there was a sample.
  template <class Handle>
  bool take(Handle&& handle) {
    bool received_any = false;
    void* sample = static_cast<typename M::Wire*>(&message_);
    dds_sample_info_t info;
    while (dds_take(reader_.id(), &sample, &info, 1, 1) == 1) {
      // Also for invalid samples: DDS clears the sequences of the message when a writer ends.
      message_.attach_storage();
      if (!info.valid_data) continue;
      count_gap(info.publication_handle, message_.sequence);
      received_any = true;
      handle(std::as_const(message_));
    }
    return received_any;
  }
  std::uint32_t matched() const {
    const dds_return_t n = dds_get_matched_publications(reader_.id(), nullptr, 0);
    return n > 0 ? static_cast<std::uint32_t>(n) : 0;
  }
  std::uint64_t missed() const { return missed_; }

 private:
  void count_gap(dds_instance_handle_t writer, std::uint64_t sequence) {
    for (auto& [known_writer, last] : last_sequences_) {
      if (known_writer != writer) continue;
      if (sequence > last + 1) missed_ += sequence - last - 1;
      last = sequence;
      return;
    }
    if (last_sequences_.size() == max_writers) last_sequences_.erase(last_sequences_.begin());
    last_sequences_.emplace_back(writer, sequence);
  }

  static constexpr std::size_t max_writers = 128;  // chosen: whose sequences are compared
  DataCallback callback_;
  std::string robot_;
  M message_{};
  std::vector<std::pair<dds_instance_handle_t, std::uint64_t>> last_sequences_;
  std::uint64_t missed_ = 0;
  Entity topic_, reader_;  // last: samples may arrive as soon as the reader exists
};

}  // namespace node
