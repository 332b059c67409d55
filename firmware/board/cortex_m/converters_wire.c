#include "firmware/board/cortex_m/converters.h"
#include "firmware/board/cortex_m/usart.h"

static wire_reader reader;
static wire_counters counters;
static wire_fault injected; /* since the last converters_fault */
static uint8_t own_address;

static void send(const uint8_t* bytes, unsigned count) {
  (void)usart_send(USART_ROBOT, bytes,
                   count); /* without room the message is lost; the next period sends a new one */
}

void converters_open(uint8_t ecu) {
  own_address = ecu;
  usart_open(USART_ROBOT);
}

void converters_start(uint8_t turn) {
  uint8_t bytes[WIRE_MESSAGE_MAX];
  send(bytes, wire_pack_sample(bytes, own_address, turn));
}

bool converters_done(board_readings* readings) {
  bool readings_received = false;
  for (uint8_t byte; usart_take(USART_ROBOT, &byte);) {
    const wire_kind kind = wire_take(&reader, byte);
    if (kind == WIRE_FAULT) wire_unpack_fault(&reader, &injected);
    if (kind == WIRE_READINGS) {
      wire_unpack_readings(&reader, readings);
      wire_count_from_reset(&counters, readings);
    }
    readings_received = readings_received || kind == WIRE_READINGS;
  }
  return readings_received;
}

wire_fault converters_fault(void) {
  const wire_fault fault = injected;
  injected.kind = 0;
  return fault;
}

void pwm_set(const int16_t* duty) {
  uint8_t bytes[WIRE_MESSAGE_MAX];
  send(bytes, wire_pack_drive(bytes, own_address, duty));
}
