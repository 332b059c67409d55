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

/// Reads every alive instance without taking it.
template <class Sample, class Use>
void for_each_alive(const Entity& reader, Use&& use,
                    std::uint32_t sample_states = DDS_ANY_SAMPLE_STATE) {
  std::vector<void*> samples(max_builtin_samples, nullptr);
  std::vector<dds_sample_info_t> info(max_builtin_samples);
  const auto n = dds_read_mask(reader.id(), samples.data(), info.data(), max_builtin_samples,
                               max_builtin_samples,
                               sample_states | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (info[k].valid_data) use(*static_cast<Sample*>(samples[k]), info[k]);
  }
  if (n > 0) dds_return_loan(reader.id(), samples.data(), n);
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
