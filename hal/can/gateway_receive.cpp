#include "hal/can/gateway.hpp"

#include <tuple>

// Frames from the ECUs: one function per kind of frame.
namespace erp {
namespace {

bool is_mode(std::uint8_t request) {
  return request >= ECU_REQUEST_VOLTAGE && request <= ECU_REQUEST_FORCE;
}

}  // namespace

FrameResult Gateway::receive(const CanFrame& frame) {
  const frame_function function = frame_function_of(&frame);
  if (function == FRAME_COMMAND || function == FRAME_PARAMETER || function == FRAME_DISCOVER)
    return FrameResult::nothing;
  if (!frame_is_intact(&frame)) return receive_corrupt();
  if (frame_ecu_of(&frame) == FRAME_EVERYONE) return receive_corrupt();
  Ecu& ecu = ecus_[frame_ecu_of(&frame)];
  if (function == FRAME_HELLO) return receive_hello(ecu, frame);
  if (!ecu.in_use) {
    ++counters_.foreign;
    return FrameResult::nothing;
  }
  if (function == FRAME_EMERGENCY) return receive_emergency(ecu, frame);
  if (!ecu.version_matches) return FrameResult::nothing;
  switch (function) {
    case FRAME_STATUS_0:
    case FRAME_STATUS_1:
      return receive_status(ecu, frame);
    case FRAME_ANALOG:
      return receive_analog(ecu, frame);
    case FRAME_HEALTH_0:
    case FRAME_HEALTH_1:
      return receive_health(ecu, frame);
    default:
      ++counters_.foreign;
      return FrameResult::nothing;
  }
}

FrameResult Gateway::receive_corrupt() {
  ++counters_.corrupt;
  return FrameResult::nothing;
}

int Gateway::channel_index(const Ecu& ecu, const CanFrame& frame, frame_function first) const {
  return ecu.channel[static_cast<std::size_t>(frame_function_of(&frame) - first)];
}

/// Counters run modulo 8. A frame that is one or two counts behind is outdated, one with the same
/// count is repeated, and a gap means lost frames.
bool Gateway::is_new(Counter& counter, std::uint8_t received) {
  const std::uint8_t ahead = counter.known ? frame_ahead(received, counter.last) : std::uint8_t{1};
  if (ahead == 0) ++counters_.repeated;
  if (ahead >= FRAME_LATE) ++counters_.late;
  if (ahead == 0 || ahead >= FRAME_LATE) return false;
  counters_.lost += ahead - 1u;
  counter = {true, received};
  return true;
}

FrameResult Gateway::receive_status(Ecu& ecu, const CanFrame& frame) {
  frame_status content;
  if (!frame_unpack_status(&frame, &content)) return receive_corrupt();
  const int index = channel_index(ecu, frame, FRAME_STATUS_0);
  if (index < 0) {
    ++counters_.foreign;
    return FrameResult::nothing;
  }
  Channel& channel = channels_[static_cast<std::size_t>(index)];
  if (!channel.encoder_known) return FrameResult::nothing;  // before the first HEALTH
  const bool is_repeated = channel.counter.known && channel.counter.last == content.counter;
  if (!is_new(channel.counter, content.counter))
    return is_repeated && index == 0 ? FrameResult::tick_repeated : FrameResult::nothing;
  const bool closes_early = channel.fresh;
  if (closes_early) close_tick();
  ecu.counter = content.counter;
  channel.fresh = true;
  --missing_;
  store(channel, samples(tick_.channels)[static_cast<std::size_t>(index)], content);
  return finish(closes_early);
}

void Gateway::store(Channel& channel, EcuChannelSample& sample, const frame_status& content) {
  if (content.state == ECU_STATE_RUNNING) {
    if (content.follows && is_mode(channel.sent.request)) channel.followed = channel.sent;
  } else {
    channel.followed = {content.request, 0};
  }
  sample.fresh = true;
  // A reset whose boot frame was lost: the next HEALTH, up to 200 ms later, reports the zero.
  const bool was_live = sample.state > ECU_STATE_BOOT && sample.state < ECU_STATE_COUNT;
  if (content.state == ECU_STATE_BOOT && was_live) sample.zero_known = false;
  sample.state = content.state;
  sample.fault = content.fault;
  sample.request = channel.followed.request;
  sample.setpoint = channel.followed.setpoint;
  sample.encoder_counts = frame_unwrap(sample.encoder_counts, content.encoder_low);
  sample.duty_counts = content.duty;
  sample.current_counts = content.current_counts;
  sample.tension_counts = content.tension_counts;
}

FrameResult Gateway::receive_analog(Ecu& ecu, const CanFrame& frame) {
  frame_analog content;
  if (!frame_unpack_analog(&frame, &content)) return receive_corrupt();
  if (!is_new(ecu.analog_page[content.page], content.counter)) return FrameResult::nothing;
  bool closes_early = false;
  for (int k = 0; k < 2; ++k) {
    const int index = ecu.analog[static_cast<std::size_t>(2 * content.page + k)];
    if (index < 0 || !(content.present >> k & 1)) continue;
    Analog& analog = analogs_[static_cast<std::size_t>(index)];
    if (analog.fresh) close_tick(), closes_early = true;
    analog.fresh = true;
    --missing_;
    EcuAnalogSample& sample = samples(tick_.analogs)[static_cast<std::size_t>(index)];
    sample.fresh = true;
    sample.counts = content.counts[k];
  }
  return finish(closes_early);
}

/// The full encoder count: the upper half from HEALTH, the lower half from the newest STATUS.
FrameResult Gateway::receive_health(Ecu& ecu, const CanFrame& frame) {
  frame_health content;
  if (!frame_unpack_health(&frame, &content)) return receive_corrupt();
  const int index = channel_index(ecu, frame, FRAME_HEALTH_0);
  if (index < 0) {
    ++counters_.foreign;
    return FrameResult::nothing;
  }
  Channel& channel = channels_[static_cast<std::size_t>(index)];
  channel.page[content.page] = content;
  if (content.page == 0) {
    auto& counts = samples(tick_.channels)[static_cast<std::size_t>(index)].encoder_counts;
    const auto low = static_cast<std::uint16_t>(counts);
    counts =
        channel.counter.known ? frame_unwrap(content.encoder_counts, low) : content.encoder_counts;
    channel.encoder_known = true;
    samples(tick_.channels)[static_cast<std::size_t>(index)].zero_known = content.zero_known;
  } else {
    channel.followed = {content.request, content.setpoint};
    EcuChannelSample& sample = samples(tick_.channels)[static_cast<std::size_t>(index)];
    sample.gain_sets_accepted = content.accepted_gain_sets;
    sample.gain_sets_refused = content.refused_gain_sets;
  }
  return FrameResult::nothing;
}

/// Bit k is set if robot.xml uses number k (index[k] >= 0) and the ECU does not have it.
template <std::size_t n>
static std::uint8_t not_fitted(const std::array<int, n>& index, unsigned fitted) {
  unsigned missing = 0;
  for (std::size_t k = 0; k < n; ++k)
    if (index[k] >= 0 && !(fitted >> k & 1u)) missing |= 1u << k;
  return static_cast<std::uint8_t>(missing);
}

FrameResult Gateway::receive_hello(Ecu& ecu, const CanFrame& frame) {
  frame_hello content;
  if (!frame_unpack_hello(&frame, &content)) return receive_corrupt();
  const auto key = [](const frame_hello& h) {
    return std::tuple(h.version, h.channels, h.analog_inputs, h.reset_cause, h.serial);
  };
  const bool has_changed = !ecu.hello || key(*ecu.hello) != key(content);
  ecu.hello = content;
  ecu.version_matches = ecu.in_use && content.version == FRAME_VERSION;
  if (has_changed && hellos_.size() < max_hellos)
    hellos_.push_back({ecu.address, ecu.in_use, content, not_fitted(ecu.channel, content.channels),
                       not_fitted(ecu.analog, content.analog_inputs)});
  return FrameResult::nothing;
}

FrameResult Gateway::receive_emergency(Ecu& ecu, const CanFrame& frame) {
  EcuEmergency emergency{ecu.address, {}};
  if (!frame_unpack_emergency(&frame, &emergency.content)) return receive_corrupt();
  if (emergencies_.size() < max_emergencies) emergencies_.push_back(emergency);
  if (!emergency.content.boot) return FrameResult::nothing;
  ecu.version_matches = emergency.content.version == FRAME_VERSION;
  ecu.hello.reset();
  reset_counters(ecu);
  return FrameResult::nothing;
}

/// After a boot the ECU counts from zero again: periods, encoder and received commands.
void Gateway::reset_counters(Ecu& ecu) {
  for (Counter& page : ecu.analog_page) page = {};
  for (int index : ecu.channel) {
    if (index < 0) continue;
    Channel& channel = channels_[static_cast<std::size_t>(index)];
    channel.counter = {};
    channel.encoder_known = false;
    samples(tick_.channels)[static_cast<std::size_t>(index)].zero_known = false;
    channel.sent = channel.followed = {};
    channel.next_position = 0;
  }
}

}  // namespace erp
