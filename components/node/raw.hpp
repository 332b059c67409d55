#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/node/bus.hpp"

/// Topics whose type is only known once they are met: who writes and reads what, and the samples
/// as they travelled.
namespace node {

/// One writer or reader on the bus.
struct Endpoint {
  std::string topic, type;
  std::string component;  ///< the name its participant joined with
  bool writer = false;
  dds_instance_handle_t handle = 0;
};

/// A topic type found on the bus; freed with the last copy.
using Descriptor = std::shared_ptr<const dds_topic_descriptor_t>;

/// Looks at the bus through DDS's own topics. No daemon.
class Discovery {
 public:
  Discovery(const Entity& participant, Wake& wake);

  /// Every writer and reader that is alive now, also our own process's.
  std::vector<Endpoint> endpoints();
  /// The type of a topic that somebody in another process writes or reads; null while unknown.
  Descriptor type_of(const std::string& topic);

 private:
  std::string participant_name(const dds_guid_t& key);
  template <class Use>
  void for_each_endpoint(Use&& use);

  const Entity& participant_;
  Arrival arrival_;
  Entity participants_, writers_, readers_;
};

/// One sample as it travelled: 4 bytes of encapsulation, then CDR.
struct RawSample {
  std::span<const std::byte> cdr;
  std::int64_t source_ns = 0;  ///< the message's stamp
  dds_instance_handle_t writer = 0;
};

/// Reads any topic, given its type.
class RawReader {
 public:
  RawReader(const Entity& participant, Wake& wake, const dds_topic_descriptor_t& type,
            const std::string& topic, int depth);

  template <class Use>
  bool take(Use&& use) {
    bool any = false;
    while (auto sample = next()) any = true, use(*sample);
    return any;
  }
  std::uint32_t matched() const;
  /// Messages DDS itself says it dropped for want of room.
  std::uint64_t lost() const;

 private:
  std::optional<RawSample> next();

  std::unique_ptr<Arrival> arrival_;  // stays where it is when the reader is moved
  std::vector<std::byte> bytes_;
  Entity topic_, reader_;
};

}  // namespace node
