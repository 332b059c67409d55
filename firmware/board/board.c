#include "firmware/board/board.h"

static ecu_channel* fitted_channel(ecu_board* board, const board_fitted* fitted, unsigned k) {
  return fitted->channels >> k & 1u ? &board->channel[k] : 0;
}

void ecu_board_init(ecu_board* board, const board_fitted* fitted, frame_reset_cause cause,
                    bus_frame* boot) {
  for (unsigned k = 0; k < 2; ++k) ecu_init(&board->channel[k]);
  ecu_link_init(&board->link, fitted->ecu, fitted_channel(board, fitted, 0),
                fitted_channel(board, fitted, 1), fitted->analog_inputs);
  board->link.serial = fitted->serial;
  board->turn = 0;
  ecu_link_pack_boot(&board->link, cause, boot);
}

void ecu_board_receive(ecu_board* board, const bus_frame* frame) {
  (void)ecu_link_receive(&board->link, frame);
}

/* The potentiometer of a channel is on the analog input given by its gains. */
static ecu_inputs inputs_of(const ecu_channel* channel, const board_readings* readings,
                            unsigned k) {
  ecu_inputs inputs = readings->channel[k];
  const float input = channel->gains[ECU_PARAMETER_WIPER_INPUT];
  if (input >= 0.0f && input < (float)ECU_ANALOG_INPUTS)
    inputs.potentiometer_counts = readings->analog[(unsigned)input];
  return inputs;
}

static int16_t tick(ecu_channel* channel, const board_period* period, unsigned k) {
  const ecu_inputs inputs = inputs_of(channel, &period->readings, k);
  ecu_overran(channel, period->overran);
  return ecu_tick(channel, &inputs);
}

unsigned ecu_board_period(ecu_board* board, const board_period* period, int16_t* duty,
                          bus_frame* frames) {
  ecu_link_bus(&board->link, period->bus_off);
  for (unsigned k = 0; k < 2; ++k) {
    duty[k] = board->link.channel[k] ? tick(board->link.channel[k], period, k) : 0;
    board->report.channel[k] = ecu_reading_of(&board->channel[k]);
  }
  for (unsigned k = 0; k < ECU_ANALOG_INPUTS; ++k)
    board->report.analog_counts[k] = period->readings.analog[k];
  board->turn = period->readings.turn;
  ecu_link_tick(&board->link);
  return ecu_link_pack(&board->link, &board->report, false, frames);
}

bool ecu_board_awaits_robot(const ecu_board* board, const board_readings* last_readings) {
  return last_readings->turn != 0u && last_readings->turn == board->turn;
}

bool ecu_board_awaits_host(const ecu_board* board, const board_readings* last_readings) {
  return ecu_board_awaits_robot(board, last_readings) && !board->link.answered;
}

unsigned ecu_board_repeat(ecu_board* board, bus_frame* frames) {
  return ecu_link_pack(&board->link, &board->report, true, frames);
}
