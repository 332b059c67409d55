#include "hal/can/gateway.hpp"

#include <tuple>

// What the ECUs say, one function a kind of frame.
namespace erp {
namespace {

bool is_mode(std::uint8_t request) {
  return request >= ECU_REQUEST_VOLTAGE && request <= ECU_REQUEST_FORCE;
}

}  // namespace

Heard Gateway::hear(const CanFrame& frame) {
  const frame_function function = frame_function_of(&frame);
  if (function == FRAME_COMMAND || function == FRAME_PARAMETER || function == FRAME_DISCOVER)
    return Heard::nothing;
  if (!frame_is_intact(&frame)) return hear_corrupt();
  if (frame_ecu_of(&frame) == FRAME_EVERYONE) return hear_corrupt();
  Ecu& ecu = ecus_[frame_ecu_of(&frame)];
  if (function == FRAME_HELLO) return hear_hello(ecu, frame);
  if (!ecu.in_use) {
    ++counters_.foreign;
    return Heard::nothing;
  }
  if (function == FRAME_EMERGENCY) return hear_emergency(ecu, frame);
  if (!ecu.speaks_ours) return Heard::nothing;
  switch (function) {
    case FRAME_STATUS_0:
    case FRAME_STATUS_1:
      return hear_status(ecu, frame);
    case FRAME_ANALOG:
      return hear_analog(ecu, frame);
    case FRAME_HEALTH_0:
    case FRAME_HEALTH_1:
      return hear_health(ecu, frame);
    default:
      ++counters_.foreign;
      return Heard::nothing;
  }
}

Heard Gateway::hear_corrupt() {
  ++counters_.corrupt;
  return Heard::nothing;
}

int Gateway::channel_index(const Ecu& ecu, const CanFrame& frame, frame_function first) const {
  return ecu.channel[static_cast<std::size_t>(frame_function_of(&frame) - first)];
}

/// Counters run modulo 8: one or two behind is late, the same is repeated, a gap is lost frames.
bool Gateway::is_new(Counter& counter, std::uint8_t heard) {
  const std::uint8_t ahead = counter.known ? frame_ahead(heard, counter.last) : std::uint8_t{1};
  if (ahead == 0) ++counters_.repeated;
  if (ahead >= FRAME_LATE) ++counters_.late;
  if (ahead == 0 || ahead >= FRAME_LATE) return false;
  counters_.lost += ahead - 1u;
  counter = {true, heard};
  return true;
}

Heard Gateway::hear_status(Ecu& ecu, const CanFrame& frame) {
  frame_status said;
  if (!frame_unpack_status(&frame, &said)) return hear_corrupt();
  const int index = channel_index(ecu, frame, FRAME_STATUS_0);
  if (index < 0) {
    ++counters_.foreign;
    return Heard::nothing;
  }
  Channel& channel = channels_[static_cast<std::size_t>(index)];
  if (!channel.encoder_known) return Heard::nothing;  // until its first HEALTH
  const bool same = channel.counter.known && channel.counter.last == said.counter;
  if (!is_new(channel.counter, said.counter))
    return same && index == 0 ? Heard::tick_repeated : Heard::nothing;
  const bool closes_early = channel.fresh;
  if (closes_early) close_tick();
  ecu.counter = said.counter;
  channel.fresh = true;
  --missing_;
  store(channel, samples(tick_.channels)[static_cast<std::size_t>(index)], said);
  return finish(closes_early);
}

void Gateway::store(Channel& channel, EcuChannelSample& sample, const frame_status& said) {
  if (said.state == ECU_STATE_RUNNING) {
    if (said.follows && is_mode(channel.sent.request)) channel.followed = channel.sent;
  } else {
    channel.followed = {said.request, 0};
  }
  sample.fresh = true;
  sample.state = said.state;
  sample.fault = said.fault;
  sample.request = channel.followed.request;
  sample.setpoint = channel.followed.setpoint;
  sample.encoder_counts = frame_unwrap(sample.encoder_counts, said.encoder_low);
  sample.duty_counts = said.duty;
  sample.current_counts = said.current_counts;
  sample.tension_counts = said.tension_counts;
}

Heard Gateway::hear_analog(Ecu& ecu, const CanFrame& frame) {
  frame_analog said;
  if (!frame_unpack_analog(&frame, &said)) return hear_corrupt();
  if (!is_new(ecu.analog_page[said.page], said.counter)) return Heard::nothing;
  bool closes_early = false;
  for (int k = 0; k < 2; ++k) {
    const int index = ecu.analog[static_cast<std::size_t>(2 * said.page + k)];
    if (index < 0 || !(said.present >> k & 1)) continue;
    Analog& analog = analogs_[static_cast<std::size_t>(index)];
    if (analog.fresh) close_tick(), closes_early = true;
    analog.fresh = true;
    --missing_;
    EcuAnalogSample& sample = samples(tick_.analogs)[static_cast<std::size_t>(index)];
    sample.fresh = true;
    sample.counts = said.counts[k];
  }
  return finish(closes_early);
}

/// The whole encoder count: the upper half is taken, the lower is the newest STATUS's.
Heard Gateway::hear_health(Ecu& ecu, const CanFrame& frame) {
  frame_health said;
  if (!frame_unpack_health(&frame, &said)) return hear_corrupt();
  const int index = channel_index(ecu, frame, FRAME_HEALTH_0);
  if (index < 0) {
    ++counters_.foreign;
    return Heard::nothing;
  }
  Channel& channel = channels_[static_cast<std::size_t>(index)];
  channel.page[said.page] = said;
  if (said.page == 0) {
    auto& counts = samples(tick_.channels)[static_cast<std::size_t>(index)].encoder_counts;
    const auto low = static_cast<std::uint16_t>(counts);
    counts = channel.counter.known ? frame_unwrap(said.encoder_counts, low) : said.encoder_counts;
    channel.encoder_known = true;
  } else {
    channel.followed = {said.request, said.setpoint};
  }
  return Heard::nothing;
}

/// Bit k: used by robot.xml, at `index[k]`, and not fitted.
template <std::size_t n>
static std::uint8_t lacking(const std::array<int, n>& index, unsigned fitted) {
  unsigned missing = 0;
  for (std::size_t k = 0; k < n; ++k)
    if (index[k] >= 0 && !(fitted >> k & 1u)) missing |= 1u << k;
  return static_cast<std::uint8_t>(missing);
}

Heard Gateway::hear_hello(Ecu& ecu, const CanFrame& frame) {
  frame_hello said;
  if (!frame_unpack_hello(&frame, &said)) return hear_corrupt();
  const auto key = [](const frame_hello& h) {
    return std::tuple(h.version, h.channels, h.analog_inputs, h.reset_cause, h.serial);
  };
  const bool is_news = !ecu.hello || key(*ecu.hello) != key(said);
  ecu.hello = said;
  ecu.speaks_ours = ecu.in_use && said.version == FRAME_VERSION;
  if (is_news && hellos_.size() < hellos_kept)
    hellos_.push_back({ecu.address, ecu.in_use, said, lacking(ecu.channel, said.channels),
                       lacking(ecu.analog, said.analog_inputs)});
  return Heard::nothing;
}

Heard Gateway::hear_emergency(Ecu& ecu, const CanFrame& frame) {
  EcuEmergency emergency{ecu.address, {}};
  if (!frame_unpack_emergency(&frame, &emergency.said)) return hear_corrupt();
  if (emergencies_.size() < emergencies_kept) emergencies_.push_back(emergency);
  if (!emergency.said.boot) return Heard::nothing;
  ecu.speaks_ours = emergency.said.version == FRAME_VERSION;
  ecu.hello.reset();
  forget(ecu);
  return Heard::nothing;
}

/// A booted ECU counts from zero again: periods, encoder, and what it has heard.
void Gateway::forget(Ecu& ecu) {
  for (Counter& page : ecu.analog_page) page = {};
  for (int index : ecu.channel) {
    if (index < 0) continue;
    Channel& channel = channels_[static_cast<std::size_t>(index)];
    channel.counter = {};
    channel.encoder_known = false;
    channel.sent = channel.followed = {};
    channel.next_position = 0;
  }
}

}  // namespace erp
