#pragma once
#include <dds/dds.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "components/node/peer.hpp"
#include "components/node/wake.hpp"
#include "interfaces/topics.hpp"

/// The only DDS plumbing of the house: owned entities, typed writers and readers.
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

/// Joins the bus, saying who we are in the participant's user data, which others can read.
/// Without CYCLONEDDS_URI the bus is this machine's loopback; ERP_DOMAIN (0…230) separates graphs.
Entity join(const Peer& self);
/// As a tool, of no robot.
Entity join(const std::string& name);

/// The Cyclone DDS configuration of that bus, for other tools that want to be on it.
const char* loopback_config();

/// Reliable, volatile, keep the last `depth` samples a key. Every topic of ours uses it.
struct Qos {
  explicit Qos(int depth = 1);
  ~Qos();
  dds_qos_t* qos;
};

Entity make_topic(const Entity& participant, const dds_topic_descriptor_t& type, const char* name);
Entity make_writer(const Entity& participant, const Entity& topic);

/// What happens, on DDS's thread, when samples are there.
struct Arrival {
  void (*act)(void* with);
  void* with;
};
/// Only raises the wake: the loop takes the samples.
Arrival waking(Wake& wake);
/// The listener is attached at creation so that no sample is missed; `arrival` must outlive it.
Entity make_reader(const Entity& participant, const Entity& topic, int depth,
                   const Arrival& arrival);
/// The same for one of DDS's own topics, which tell who is on the bus.
Entity make_builtin_reader(const Entity& participant, dds_entity_t topic, const Arrival& arrival);

/// Publishes messages of one type.
template <class M>
class Writer {
 public:
  explicit Writer(const Entity& participant)
      : topic_(make_topic(participant, *erp::Topic<M>::type, erp::Topic<M>::name)),
        writer_(make_writer(participant, topic_)) {}

  /// Numbers and sends the message. Throws std::runtime_error when DDS refuses it.
  void write(M& message) {
    message.sequence = sequence_++;
    send(message);
  }
  /// Sends the message with the number it carries; its stamp is the DDS source timestamp too.
  void send(const M& message) {
    const dds_return_t rc = dds_write_ts(
        writer_.id(), static_cast<const typename M::Wire*>(&message), message.stamp_ns);
    if (rc < 0)
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

/// Takes messages of one type; counts the numbers that never came.
template <class M>
class Reader {
 public:
  Reader(const Entity& participant, Wake& wake, int depth = 1)
      : Reader(participant, waking(wake), depth) {}
  Reader(const Entity& participant, const Arrival& arrival, int depth = 1)
      : arrival_(arrival),
        topic_(make_topic(participant, *erp::Topic<M>::type, erp::Topic<M>::name)),
        reader_(make_reader(participant, topic_, depth, arrival_)) {}
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Hands every waiting sample to `use`, oldest first; touches no heap of ours.
  template <class Use>
  bool take(Use&& use) {
    bool any = false;
    void* sample = static_cast<typename M::Wire*>(&message_);
    dds_sample_info_t info;
    while (dds_take(reader_.id(), &sample, &info, 1, 1) == 1) {
      if (!info.valid_data) continue;
      message_.lend();
      count_gap(info.publication_handle, message_.sequence);
      any = true;
      use(std::as_const(message_));
    }
    return any;
  }
  std::uint32_t matched() const {
    const dds_return_t n = dds_get_matched_publications(reader_.id(), nullptr, 0);
    return n > 0 ? static_cast<std::uint32_t>(n) : 0;
  }
  std::uint64_t missed() const { return missed_; }

 private:
  void count_gap(dds_instance_handle_t writer, std::uint64_t sequence) {
    for (auto& [handle, last] : last_) {
      if (handle != writer) continue;
      if (sequence > last + 1) missed_ += sequence - last - 1;
      last = sequence;
      return;
    }
    last_.emplace_back(writer, sequence);
  }

  Arrival arrival_;
  M message_{};
  std::vector<std::pair<dds_instance_handle_t, std::uint64_t>> last_;
  std::uint64_t missed_ = 0;
  Entity topic_, reader_;  // last: samples may arrive as soon as they exist
};

}  // namespace node
