#pragma once
#include <dds/dds.h>

#include <cstdint>
#include <string>
#include <vector>

#include "components/node/bus.hpp"

/// Access to DDS's built-in topics, which list the participants and endpoints on the bus.
namespace node {

inline constexpr std::uint32_t max_builtin_samples = 1024;

/// Sample state mask: only samples that this reader has not read yet.
inline constexpr std::uint32_t unread_only = DDS_NOT_READ_SAMPLE_STATE;

/// Buffers for loaned samples. Their size is constant, because DDS always lends a reader as many
/// samples as in its largest loan.
struct BuiltinSamples {
  std::vector<void*> samples = std::vector<void*>(max_builtin_samples, nullptr);
  std::vector<dds_sample_info_t> info = std::vector<dds_sample_info_t>(max_builtin_samples);

  template <class Get>
  std::size_t get(const Entity& reader, Get read_or_take, std::uint32_t mask) {
    const auto n = read_or_take(reader.id(), samples.data(), info.data(), max_builtin_samples,
                                max_builtin_samples, mask);
    return n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  void return_loan(const Entity& reader, std::size_t n) {
    if (n > 0) dds_return_loan(reader.id(), samples.data(), static_cast<std::int32_t>(n));
    samples[0] = nullptr;
  }
};

/// Takes the instances that are no longer alive; DDS stores them until they are taken.
inline void discard_not_alive(const Entity& reader, BuiltinSamples& buffers) {
  const std::size_t n = buffers.get(reader, dds_take_mask,
                                    DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE |
                                        DDS_NOT_ALIVE_DISPOSED_INSTANCE_STATE |
                                        DDS_NOT_ALIVE_NO_WRITERS_INSTANCE_STATE);
  buffers.return_loan(reader, n);
}

/// Reads every alive instance without taking it; discards the others.
template <class Sample, class Visit>
void for_each_alive(const Entity& reader, Visit&& visit,
                    std::uint32_t sample_states = DDS_ANY_SAMPLE_STATE) {
  BuiltinSamples buffers;
  discard_not_alive(reader, buffers);
  const std::size_t n = buffers.get(reader, dds_read_mask,
                                    sample_states | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
  for (std::size_t k = 0; k < n; ++k)
    if (buffers.info[k].valid_data)
      visit(*static_cast<Sample*>(buffers.samples[k]), buffers.info[k]);
  buffers.return_loan(reader, n);
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
