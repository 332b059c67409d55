/* The control laws on many inputs. Built for the microcontroller, the program prints the results,
 * one per line. Built for this machine, it reads those results and compares, in units in the last
 * place (ulp). */
#include "firmware/core/laws.h"

#include <stdint.h>
#include <string.h>

#define INPUTS 2000

static void handle_result(float value);

/* -1 … 1, the same sequence on every machine (generator of Numerical Recipes). */
static float next(void) {
  static uint32_t state = 1;
  state = state * 1664525u + 1013904223u;
  return (float)(int32_t)state / 2147483648.0f;
}

static void all_laws(void) {
  law_current_memory memory = {0.0f, 0.0f};
  for (int k = 0; k < INPUTS; ++k) {
    float x[8]; /* an array, so that all compilers draw in the same order */
    for (int i = 0; i < 8; ++i) x[i] = next();
    const law_force_gains gains = {3.0f * x[0], x[1], x[2], x[3]};
    handle_result(law_length_V(40.0f * x[0], 20.0f * x[1], 20.0f * x[2]));
    handle_result(
        law_current_V(&memory, x[3], 100.0f * x[4], 0.01f * x[5], 4.0f * x[6], 12.0f, 0.002f));
    handle_result(memory.integral_V);
    handle_result(law_force_V(&gains, 150.0f * x[4], 6.0f * x[5], 8.0f * x[6], 150.0f * x[7]));
    handle_result(
        law_limit_current_V(20.0f * x[0], 8.0f * x[1], 0.5f + 0.4f * x[2], 1.47f, 4.0f, 12.0f));
  }
}

static uint32_t bits_of(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

#ifdef __arm__

/* Semihosting: the debugger or QEMU performs the operation (ARM DUI 0471, 8). */
static void call_host(uint32_t operation, const void* argument) {
  register uint32_t r0 __asm("r0") = operation;
  register const void* r1 __asm("r1") = argument;
  __asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

static void handle_result(float value) {
  char line[10];
  for (int i = 0; i < 8; ++i) line[i] = "0123456789abcdef"[bits_of(value) >> (28 - 4 * i) & 15u];
  line[8] = '\n';
  line[9] = 0;
  call_host(0x04, line); /* SYS_WRITE0 */
}

int main(void) {
  all_laws();
  call_host(0x18, (const void*)0x20026); /* SYS_EXIT: done */
  return 0;
}

#else
#include <stdio.h>
#include <stdlib.h>

static unsigned compared, different, worst_ulp;

static int64_t order_of(uint32_t bits) {
  return bits & 0x80000000u ? -(int64_t)(bits & 0x7FFFFFFFu) : (int64_t)bits;
}

static void handle_result(float value) {
  unsigned expected_bits;
  if (scanf("%x", &expected_bits) != 1) {
    printf("the microcontroller printed %u of %d numbers\n", compared, 5 * INPUTS);
    exit(1);
  }
  const unsigned ulp = (unsigned)llabs(order_of(bits_of(value)) - order_of(expected_bits));
  ++compared;
  different += ulp != 0;
  if (ulp > worst_ulp) worst_ulp = ulp;
}

int main(void) {
  all_laws();
  printf("%u numbers of the control laws, %u differ, by at most %u ulp\n", compared, different,
         worst_ulp);
  return worst_ulp <= 1 ? 0 : 1;
}
#endif
