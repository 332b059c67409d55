/* One ECU channel, the gateway and the plant, in rounds of one period each. Until `calm` is set, each of
 * the three may be delayed, stop and restart, sensors may trip, and the bus may lose, repeat, delay and
 * reorder frames. spin checks every order of these events:
 *
 *   the channel runs only on a command that is not older than the watchdog plus the longest delay of the bus;
 *   it never runs on a command older than the previous one;
 *   after a fault it runs only after a clear, an arm and a new set-point, in that order;
 *   it does not leave a sensor fault, because this model never clears such a fault;
 *   there is no deadlock; when `calm` is set, a channel with working sensors starts and keeps running.
 *
 * The state machine is that of the firmware: transitions.cpp prints it from firmware/core/state.c. Copied by
 * hand: is_fresh of link.c, the count of gateway.cpp, decide of actuator_channel.cpp. Shortened: the watchdog,
 * which has 25 periods in the firmware. Assumed: no frame is in transit longer than DELAY periods, because
 * counters of three bits cannot identify an older one. */
#include "transitions.pml"

#define WATCHDOG 3
#define DELAY 2
#ifndef LATE
#define LATE 6 /* FRAME_LATE */
#endif
#define NOTHING 7

#define NONE 0 /* faults */
#define SILENCE 1
#define SENSOR 2

typedef frame { byte request = NOTHING; byte fault; byte count; byte age };

bool calm;
byte turn; /* 0 plant, 1 gateway, 2 bus, 3 ECU */

frame pending; /* plant -> gateway: only the newest */
frame bus[2];

/* ECU */
byte state = BOOT, fault, since;
bool received;
byte last_count;
/* state of the ECU as known to plant and gateway */
byte reported_state = BOOT, reported_fault, count;
/* ghost variables, for the properties only */
byte followed_age;          /* age of the command in effect */
bool cleared = true, armed; /* since the last fault */

#define ahead(new, old) ((new + 8 - old) % 8)

inline clear_frame(f) { f.request = NOTHING; f.fault = 0; f.count = 0; f.age = 0 }

/* A restart takes longer than any frame is in transit. */
inline clear_wires() { clear_frame(pending); clear_frame(bus[0]); clear_frame(bus[1]) }

inline copy(to, from) {
  to.request = from.request; to.fault = from.fault; to.count = from.count; to.age = from.age
}

/* ---- plant: components/plant/actuator_channel.cpp, with a controller that always commands a motion ---- */

inline decide() {
  if
  :: reported_state == BOOT -> pending.request = COMMIT /* gain set */
  :: reported_state == IDLE -> pending.request = ARM
  :: reported_state == ARMED || reported_state == RUNNING -> pending.request = SETPOINT
  :: reported_state == FAULT && reported_fault == SILENCE -> pending.request = CLEAR; pending.fault = reported_fault
  :: reported_state == FAULT && reported_fault != SILENCE -> pending.request = OFF
  fi;
  pending.age = 0
}

active proctype plant() {
  do
  :: atomic { turn == 0 ->
       if
       :: decide()
       :: !calm /* delayed, killed or stopped */
       :: !calm -> reported_state = BOOT /* restarts without state */
       fi;
       turn = 1 }
  od
}

/* ---- gateway: hal/can/gateway.cpp ---- */

/* Renumbers the counts so that the newest is 0, once in a round. The ECU compares counts by their difference
 * only, so this changes no behaviour, and leaves an eighth of the states. */
inline renumber() {
  last_count = (received -> ahead(last_count, count) : 0);
  bus[0].count = (bus[0].request != NOTHING -> ahead(bus[0].count, count) : 0);
  bus[1].count = (bus[1].request != NOTHING -> ahead(bus[1].count, count) : 0);
  count = 0
}

/* A restarted gateway counts from 0, which is any count in the numbers of renumber(). */
inline restart_count() {
  if
  :: count = 0 :: count = 1 :: count = 2 :: count = 3
  :: count = 4 :: count = 5 :: count = 6 :: count = 7
  fi
}

inline send(f) {
  count = (count + 1) % 8;
  copy(f, pending); f.count = count; clear_frame(pending)
}

active proctype gateway() {
  do
  :: atomic { turn == 1 ->
       if
       :: pending.request != NOTHING && bus[0].request == NOTHING ->
          send(bus[0])
       :: pending.request != NOTHING && bus[0].request != NOTHING && bus[1].request == NOTHING ->
          send(bus[1])
       :: pending.request == NOTHING || (bus[0].request != NOTHING && bus[1].request != NOTHING)
       :: !calm                                  /* delayed: only the newest command waits */
       :: !calm -> clear_wires(); restart_count()
       fi;
       turn = 2 }
  od
}

/* ---- ECU: firmware/core/link.c, ecu.c ---- */

inline follow(f) {
  if
  :: f.request == COMMIT -> take(COMMIT)
  :: f.request == OFF -> take(OFF)
  :: f.request == CLEAR ->
     if
     :: state == FAULT && f.fault == fault ->
        assert(fault != SENSOR); /* not cleared by this model */
        fault = NONE; cleared = true; armed = false;
        take(CLEAR)
     :: else
     fi
  :: f.request == ARM ->
     take(ARM);
     if :: state == ARMED -> since = 0; armed = true; followed_age = f.age :: else fi
  :: f.request == SETPOINT ->
     take(SETPOINT);
     if
     :: state == RUNNING ->
        assert(cleared && armed);        /* clear, arm, then a set-point */
        assert(f.age <= followed_age);   /* never an age_frame command */
        since = 0; followed_age = f.age
     :: else
     fi
  fi
}

/* COMMIT stands for a gain set, which has no counter and causes no motion. */
inline receive(f) {
  if
  :: f.request == COMMIT -> follow(f)
  :: f.request != COMMIT &&
     (!received || (ahead(f.count, last_count) > 0 && ahead(f.count, last_count) < LATE)) ->
     received = true; last_count = f.count;
     follow(f)
  :: else /* outdated or repeated */
  fi
}

/* The first cause is kept. */
inline trip(cause) {
  if
  :: state != FAULT ->
     take(TRIP);
     if :: state == FAULT -> fault = cause; cleared = false; armed = false :: else fi
  :: else
  fi
}

inline reset() {
  state = BOOT; fault = NONE; since = 0; received = false; last_count = 0;
  followed_age = 0; cleared = true; armed = false; clear_wires()
}

inline period() {
  if
  :: (state == ARMED || state == RUNNING) && since >= WATCHDOG -> trip(SILENCE)
  :: (state == ARMED || state == RUNNING) && since < WATCHDOG -> since++
  :: else
  fi;
  followed_age = (followed_age < 15 -> followed_age + 1 : 15);
  /* it runs only on a fresh command, and only after clear and arm */
  assert(state != RUNNING || (since <= WATCHDOG && followed_age <= WATCHDOG + DELAY));
  assert(state != RUNNING || (cleared && armed))
}

active proctype ecu() {
  do
  :: atomic { turn == 3 ->
       if
       :: period()
       :: !calm -> period(); trip(SENSOR)
       :: !calm -> reset()
       fi;
       if :: reported_state = state; reported_fault = fault :: !calm /* its STATUS is lost */ fi;
       if :: calm :: calm = true :: !calm fi;
       renumber();
       turn = 0 }
  od
}

/* ---- bus ---- */

inline age_frame(f) {
  if
  :: f.request != NOTHING -> f.age++; if :: f.age > DELAY -> clear_frame(f) :: else fi
  :: else
  fi
}

active proctype wire() {
  do
  :: atomic { turn == 2 ->
       if
       :: bus[0].request != NOTHING -> receive(bus[0]); clear_frame(bus[0])
       :: bus[0].request != NOTHING && !calm -> receive(bus[0])     /* repeated */
       :: bus[0].request != NOTHING && !calm -> clear_frame(bus[0])   /* lost */
       :: bus[1].request != NOTHING -> receive(bus[1]); clear_frame(bus[1]) /* overtakes */
       :: !calm || (bus[0].request == NOTHING && bus[1].request == NOTHING)
       fi;
       if :: calm && bus[1].request != NOTHING -> receive(bus[1]); clear_frame(bus[1]) :: else fi;
       age_frame(bus[0]); age_frame(bus[1]); age_frame(pending);
       turn = 3 }
  od
}

#define undisturbed (calm && fault != SENSOR)
ltl comes_to_run { [] (undisturbed -> <> (state == RUNNING)) }
ltl stays_running { [] (undisturbed -> <> [] (state == RUNNING)) }
