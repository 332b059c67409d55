// Prints the state machine of firmware/core/state.c as Promela, so that model and code always agree.
#include <array>
#include <cstdio>

#include "firmware/core/state.h"

namespace {

constexpr std::array states{"BOOT", "IDLE", "ARMED", "RUNNING", "FAULT"};
constexpr std::array events{"COMMIT", "OFF", "CLEAR", "ARM", "SETPOINT", "TRIP"};
static_assert(states.size() == ECU_STATE_COUNT && events.size() == ECU_EVENT_COUNT);

}  // namespace

int main() {
  for (std::size_t s = 0; s < states.size(); ++s) std::printf("#define %s %zu\n", states[s], s);
  for (std::size_t e = 0; e < events.size(); ++e) std::printf("#define %s %zu\n", events[e], e);
  std::printf("inline take(event) {\n  if\n");
  for (std::size_t s = 0; s < states.size(); ++s)
    for (std::size_t e = 0; e < events.size(); ++e)
      std::printf("  :: state == %s && event == %s -> state = %s\n", states[s], events[e],
                  states[ecu_next_state(static_cast<ecu_state>(s), static_cast<ecu_event>(e))]);
  std::printf("  fi\n}\n");
}
