#pragma once
#include <dds/dds.h>

#include <cstdint>
#include <string>
#include <vector>

#include "components/node/bus.hpp"

/// DDS's own topics, which tell who is on the bus.
namespace node {

inline constexpr std::uint32_t max_builtin_samples = 1024;

/// To see only what nobody has read through that reader yet.
inline constexpr std::uint32_t only_new = DDS_NOT_READ_SAMPLE_STATE;

/// Room for what is read. Always the same: DDS lends as much as it ever lent through a reader.
struct BuiltinSamples {
  std::vector<void*> samples = std::vector<void*>(max_builtin_samples, nullptr);
  std::vector<dds_sample_info_t> info = std::vector<dds_sample_info_t>(max_builtin_samples);

  template <class Get>
  std::size_t get(const Entity& reader, Get how, std::uint32_t mask) {
    const auto n = how(reader.id(), samples.data(), info.data(), max_builtin_samples,
                       max_builtin_samples, mask);
    return n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  void give_back(const Entity& reader, std::size_t n) {
    if (n > 0) dds_return_loan(reader.id(), samples.data(), static_cast<std::int32_t>(n));
    samples[0] = nullptr;
  }
};

/// DDS keeps what it knows of those who have gone until somebody takes it.
inline void forget_the_gone(const Entity& reader, BuiltinSamples& room) {
  const std::size_t gone =
      room.get(reader, dds_take_mask,
               DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_NOT_ALIVE_DISPOSED_INSTANCE_STATE |
                   DDS_NOT_ALIVE_NO_WRITERS_INSTANCE_STATE);
  room.give_back(reader, gone);
}

/// Reads every alive instance without taking it; forgets the others.
template <class Sample, class Use>
void for_each_alive(const Entity& reader, Use&& use,
                    std::uint32_t sample_states = DDS_ANY_SAMPLE_STATE) {
  BuiltinSamples room;
  forget_the_gone(reader, room);
  const std::size_t n = room.get(reader, dds_read_mask,
                                 sample_states | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
  for (std::size_t k = 0; k < n; ++k)
    if (room.info[k].valid_data) use(*static_cast<Sample*>(room.samples[k]), room.info[k]);
  room.give_back(reader, n);
}

inline std::string user_data(const dds_qos_t* qos) {
  void* value = nullptr;
  std::size_t size = 0;
  if (!qos || !dds_qget_userdata(qos, &value, &size) || !value) return {};
  std::string text(static_cast<const char*>(value), size);
  dds_free(value);
  return text;
}

}  // namespace node
