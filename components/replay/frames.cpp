#include "components/replay/frames.hpp"

#include <stdexcept>

#include "interfaces/recording/fields.hpp"
#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/ros2msg.hpp"

namespace replay {
namespace {

/// The value of a numeric field of at most 32 bits; 0 if the recording is of a version without that field.
template <class T>
T number(const recording::Members& members, const char* name) {
  const auto* value = members.find(name);
  return value && value->number() ? static_cast<T>(*value->number()) : T{};
}

bool boolean(const recording::Members& members, const char* name) {
  const auto* value = members.find(name);
  const bool* data = value ? std::get_if<bool>(&value->data) : nullptr;
  return data && *data;
}

erp::EcuChannelSample channel_of(const recording::Members& m) {
  erp::EcuChannelSample channel{};
  channel.ecu = number<std::uint8_t>(m, "ecu");
  channel.channel = number<std::uint8_t>(m, "channel");
  channel.fresh = boolean(m, "fresh");
  channel.state = number<std::uint8_t>(m, "state");
  channel.fault = number<std::uint8_t>(m, "fault");
  channel.request = number<std::uint8_t>(m, "request");
  channel.setpoint = number<std::int32_t>(m, "setpoint");
  // Recordings of versions without this field contain only absolute counts.
  channel.zero_known = !m.find("zero_known") || boolean(m, "zero_known");
  channel.encoder_counts = number<std::int32_t>(m, "encoder_counts");
  channel.duty_counts = number<std::int16_t>(m, "duty_counts");
  channel.current_counts = number<std::int16_t>(m, "current_counts");
  channel.tension_counts = number<std::uint16_t>(m, "tension_counts");
  channel.gain_sets_accepted = number<std::uint8_t>(m, "gain_sets_accepted");
  channel.gain_sets_refused = number<std::uint8_t>(m, "gain_sets_refused");
  return channel;
}

erp::EcuAnalogSample analog_of(const recording::Members& m) {
  erp::EcuAnalogSample analog{};
  analog.ecu = number<std::uint8_t>(m, "ecu");
  analog.input = number<std::uint8_t>(m, "input");
  analog.fresh = boolean(m, "fresh");
  analog.counts = number<std::int32_t>(m, "counts");
  return analog;
}

}  // namespace

Frames::Frames(const std::string& file) {
  if (file.empty())
    throw std::invalid_argument("replay: the recording is missing; give --set file=RECORDING.mcap");
  const recording::McapReader reader(file);
  const auto add = [&](const recording::Message& message) {
    if (message.channel.topic != erp::Topic<erp::EcuFrame>::name) return;
    if (messages_.empty()) {
      const auto& schema = reader.schemas().at(message.channel.schema_id);
      type_ = recording::parse_ros2msg(schema.name, schema.data);
    }
    messages_.emplace_back(message.data.begin(), message.data.end());
    const auto header = recording::header_of(type_, message.data);
    times_ns_.push_back(
        times_.add(header.stamp_ns.value_or(0), header.sequence.value_or(0), message.log_time_ns));
  };
  reader.for_each(add, recording::Order::file);
  if (messages_.empty())
    throw std::invalid_argument(file + ": contains no ecu_frame; record one with the logger");
}

erp::EcuFrame Frames::at(std::size_t k) const {
  const auto members = recording::decode_cdr(type_, messages_[k]);
  erp::EcuFrame frame;
  frame.stamp_ns = recording::integer_in<std::int64_t>(members, "stamp_ns");
  frame.sequence = recording::integer_in<std::uint64_t>(members, "sequence");
  if (const auto* channels = members.find("channels"))
    for (const auto& value : *channels->elements())
      erp::append(frame.channels, channel_of(*value.members()));
  if (const auto* analogs = members.find("analogs"))
    for (const auto& value : *analogs->elements())
      erp::append(frame.analogs, analog_of(*value.members()));
  return frame;
}

std::vector<std::string> Frames::clock_steps() const {
  std::vector<std::string> lines;
  for (const auto& step : times_.steps()) lines.push_back(recording::text_of(step, times_ns_[0]));
  return lines;
}

}  // namespace replay
