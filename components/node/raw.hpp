#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/node/bus.hpp"

/// Topics whose type is known only at run time: their writers and readers, and serialized samples.
namespace node {

/// One writer or reader on the bus.
struct Endpoint {
  std::string topic, type;
  std::string component;  ///< component name of its participant
  bool writer = false;
  dds_instance_handle_t handle = 0;
};

/// A topic type found on the bus; freed with the last copy.
using Descriptor = std::shared_ptr<const dds_topic_descriptor_t>;

/// Lists the endpoints on the bus from DDS's built-in topics. Needs no daemon.
class Discovery {
 public:
  Discovery(const Entity& participant, Wake& wake);

  /// Every writer and reader that is alive now, including those of this process.
  std::vector<Endpoint> endpoints();
  /// The type of a topic that another process writes or reads; null while unknown.
  Descriptor type_of(const std::string& topic);

 private:
  std::string participant_name(const dds_guid_t& key);

  const Entity& participant_;
  DataCallback callback_;
  Entity participants_, writers_, readers_;
};

/// One serialized sample: 4 bytes of encapsulation, then CDR.
struct RawSample {
  std::span<const std::byte> cdr;
  std::int64_t source_ns = 0;  ///< the message's stamp
  dds_instance_handle_t writer = 0;
};

/// Reads any topic, given its type.
class RawReader {
 public:
  /// `robot`: as in make_topic.
  RawReader(const Entity& participant, Wake& wake, const dds_topic_descriptor_t& type,
            const std::string& topic, int depth, const std::string& robot = {});

  template <class Handle>
  bool take(Handle&& handle) {
    bool taken_any = false;
    while (auto sample = next()) taken_any = true, handle(*sample);
    return taken_any;
  }
  std::uint32_t matched() const;
  /// Messages that DDS reports as lost because its queue was full.
  std::uint64_t lost() const;

 private:
  std::optional<RawSample> next();

  // Their addresses stay valid when the reader is moved.
  std::unique_ptr<DataCallback> callback_;
  std::unique_ptr<const std::string> robot_;
  std::vector<std::byte> bytes_;
  Entity topic_, reader_;
};

}  // namespace node
