#include "firmware/core/link.h"

void ecu_link_init(ecu_link* link, uint8_t ecu, ecu_channel* channel_0, ecu_channel* channel_1,
                   uint8_t analog_inputs) {
  *link = (ecu_link){.ecu = ecu, .analog_inputs = analog_inputs, .channel = {channel_0, channel_1}};
}

void ecu_link_tick(ecu_link* link) {
  ++link->tick;
  link->answered = false;
}

static uint8_t counter(const ecu_link* link) { return (uint8_t)(link->tick & 7u); }

/* ---- receiving ---- */

static void trip_both(ecu_link* link, ecu_fault fault) {
  for (int k = 0; k < 2; ++k)
    if (link->channel[k]) ecu_trip(link->channel[k], fault);
}

void ecu_link_bus(ecu_link* link, bool bus_off) {
  if (bus_off) trip_both(link, ECU_FAULT_BUS_OFF);
}

static bool receive_corrupt(ecu_link* link) {
  ++link->corrupt;
  if (++link->consecutive_corrupt >= ECU_CORRUPT_TRIP) trip_both(link, ECU_FAULT_CORRUPT);
  return false;
}

/* True if the command is newer than the last received one. Counters run modulo 8; a command that is
 * one or two counts behind is outdated. */
static bool is_fresh(ecu_link* link, const frame_command* command) {
  if (!link->has_received) return true;
  const unsigned ahead = frame_ahead(command->count, link->last_count);
  if (ahead == 0) {
    ++link->repeated;
    return false;
  }
  if (ahead >= FRAME_LATE) {
    ++link->late;
    return false;
  }
  link->lost += ahead - 1u;
  return true;
}

static bool receive_command(ecu_link* link, const frame_command* command) {
  if (!is_fresh(link, command)) return false;
  link->has_received = true;
  link->last_count = command->count;
  link->answered = link->answered || command->answers == counter(link);
  for (int k = 0; k < 2; ++k) {
    const frame_channel_command* content = &command->channel[k];
    if (link->channel[k] && content->request != FRAME_REQUEST_NONE)
      link->follows[k] =
          ecu_command(link->channel[k], (ecu_request)content->request, content->setpoint);
  }
  return true;
}

static uint8_t position_after(uint8_t position) {
  return position == 255 ? 1 : (uint8_t)(position + 1);
}

/* The host needs the full encoder count that follows from the new zero. */
static bool receive_zero(ecu_link* link, ecu_channel* channel, const frame_parameter* content) {
  link->hello_requested = true;
  return ecu_parameter(channel, content->index, content->value, false);
}

/* Position 0 begins a set; the same position again is a repeated frame; a gap invalidates the
 * set. */
static bool receive_parameter(ecu_link* link, const frame_parameter* content) {
  const uint8_t k = content->channel, last_position = link->last_position[k];
  ecu_channel* channel = link->channel[k];
  if (!channel) return false;
  if (content->index == ECU_ZERO) return receive_zero(link, channel, content);
  if (content->position != 0 && content->position == last_position) {
    ++link->repeated;
    return false;
  }
  if (content->position == 0) ecu_discard_parameters(channel);
  else if (!link->set_open[k] || content->position != position_after(last_position))
    ecu_invalidate_staged(channel);
  link->last_position[k] = content->position;
  link->set_open[k] = !content->commit;
  return ecu_parameter(channel, content->index, content->value, content->commit);
}

static bool receive_discover(ecu_link* link, const bus_frame* frame) {
  if (!frame_unpack_discover(frame)) return false;
  link->hello_requested = true;
  return true;
}

bool ecu_link_receive(ecu_link* link, const bus_frame* frame) {
  const frame_function function = frame_function_of(frame);
  const uint8_t to = frame_ecu_of(frame);
  if (to == FRAME_EVERYONE || function == FRAME_DISCOVER)
    return (to == FRAME_EVERYONE || to == link->ecu) && receive_discover(link, frame);
  if (to != link->ecu) return false;
  if (function != FRAME_COMMAND && function != FRAME_PARAMETER) return false;
  frame_command command;
  frame_parameter parameter;
  const bool is_command = frame_unpack_command(frame, &command);
  if (!is_command && !frame_unpack_parameter(frame, &parameter)) return receive_corrupt(link);
  link->consecutive_corrupt = 0;
  return is_command ? receive_command(link, &command) : receive_parameter(link, &parameter);
}

/* ---- sending ---- */

ecu_reading ecu_reading_of(const ecu_channel* channel) {
  return (ecu_reading){.state = channel->state,
                       .fault = channel->fault,
                       .request = channel->request,
                       .setpoint = channel->setpoint,
                       .inputs = channel->sensed.inputs,
                       .duty = channel->duty};
}

static void pack_health(const ecu_link* link, uint8_t k, uint8_t page, const ecu_reading* reading,
                        bus_frame* frame) {
  const ecu_channel* channel = link->channel[k];
  const frame_health content = {.page = page,
                                .counter = counter(link),
                                .encoder_counts = reading->inputs.encoder_counts,
                                .warning = ecu_is_warning(channel),
                                .lost = (uint8_t)link->lost,
                                .corrupt = (uint8_t)link->corrupt,
                                .zero_known = channel->zero_known,
                                .request = (uint8_t)reading->request,
                                .setpoint = reading->setpoint,
                                .rejected = (uint16_t)channel->rejected_setpoints,
                                .refused_gain_sets = (uint8_t)channel->rejected_commits,
                                .accepted_gain_sets = (uint8_t)(channel->accepted_commits & 7u)};
  frame_pack_health(frame, link->ecu, k, &content);
}

static void pack_status(const ecu_link* link, uint8_t k, const ecu_reading* reading,
                        bus_frame* frame) {
  const frame_status content = {.encoder_low = (uint16_t)reading->inputs.encoder_counts,
                                .current_counts = reading->inputs.current_counts,
                                .tension_counts = reading->inputs.tension_counts,
                                .state = (uint8_t)reading->state,
                                .duty = reading->duty,
                                .fault = (uint8_t)reading->fault,
                                .request = (uint8_t)reading->request,
                                .warning = ecu_is_warning(link->channel[k]),
                                .follows = link->follows[k],
                                .counter = counter(link)};
  frame_pack_status(frame, link->ecu, k, &content);
}

static void pack_analog(const ecu_link* link, uint8_t page, const int32_t* counts,
                        bus_frame* frame) {
  const frame_analog content = {.page = page,
                                .present = link->analog_inputs >> 2 * page & 3,
                                .counts = {counts[2 * page], counts[2 * page + 1]},
                                .counter = counter(link)};
  frame_pack_analog(frame, link->ecu, &content);
}

static void pack_hello(const ecu_link* link, bus_frame* frame) {
  const frame_hello content = {
      .version = FRAME_VERSION,
      .channels = (uint8_t)((link->channel[0] ? 1u : 0u) | (link->channel[1] ? 2u : 0u)),
      .analog_inputs = link->analog_inputs,
      .reset_cause = link->reset_cause,
      .serial = link->serial};
  frame_pack_hello(frame, link->ecu, &content);
}

/* A fault is reported once, when it is new. */
static bool has_new_fault(ecu_link* link, uint8_t k, const ecu_reading* reading) {
  const bool reported_before = link->reported_fault[k];
  link->reported_fault[k] = reading->state == ECU_STATE_FAULT;
  return link->reported_fault[k] && !reported_before;
}

static void pack_fault(const ecu_link* link, uint8_t k, ecu_fault fault, bus_frame* frame) {
  const frame_emergency content = {
      .channel = k, .fault = (uint8_t)fault, .version = FRAME_VERSION, .tick = link->tick};
  frame_pack_emergency(frame, link->ecu, &content);
}

static unsigned pack_new_faults(ecu_link* link, const ecu_report* report, bus_frame* frames) {
  unsigned count = 0;
  for (uint8_t k = 0; k < 2; ++k)
    if (link->channel[k] && has_new_fault(link, k, &report->channel[k]))
      pack_fault(link, k, report->channel[k].fault, &frames[count++]);
  return count;
}

/* One page every 50 ms, in rotation, or all pages. */
static unsigned pack_healths(ecu_link* link, const ecu_report* report, bool all_pages,
                             bus_frame* frames) {
  unsigned count = 0;
  const bool due = (link->tick + link->ecu) % ECU_HEALTH_TICKS == 0;
  for (uint8_t k = 0; k < 2; ++k)
    for (uint8_t page = 0; page < 2; ++page)
      if (link->channel[k] && (all_pages || (due && link->next_health_page == 2 * page + k)))
        pack_health(link, k, page, &report->channel[k], &frames[count++]);
  if (due) link->next_health_page = (link->next_health_page + 1) & 3;
  return count;
}

unsigned ecu_link_pack(ecu_link* link, const ecu_report* report, bool all_pages,
                       bus_frame* frames) {
  const bool send_all = all_pages || link->hello_requested;
  link->hello_requested = false;
  unsigned count = pack_new_faults(link, report, frames);
  if (send_all) pack_hello(link, &frames[count++]);
  count += pack_healths(link, report, send_all, frames + count);
  for (uint8_t page = 0; page < 2; ++page)
    if (link->analog_inputs >> 2 * page & 3)
      pack_analog(link, page, report->analog_counts, &frames[count++]);
  for (uint8_t k = 0; k < 2; ++k)
    if (link->channel[k]) pack_status(link, k, &report->channel[k], &frames[count++]);
  return count;
}

void ecu_link_pack_boot(ecu_link* link, frame_reset_cause cause, bus_frame* frame) {
  link->reset_cause = (uint8_t)cause;
  const frame_emergency content = {
      .boot = true, .reset_cause = (uint8_t)cause, .version = FRAME_VERSION, .tick = link->tick};
  frame_pack_emergency(frame, link->ecu, &content);
}
