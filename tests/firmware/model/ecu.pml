/* One channel of an ECU, the gateway and the plant, round by round: a period each. Until `calm`, each
 * of the three may be late, die and come back, sensors may trip, and the bus may lose, repeat, delay
 * and reorder. Checked by spin for every order of all that:
 *
 *   it runs only on a command no older than the watchdog and the bus's longest delay;
 *   never on a command older than the one it followed before;
 *   after a fault it is silent until a clear, an arm and a new set-point were heard, in that order;
 *   a sensor's fault is not left at all, since nobody here asks for it;
 *   no deadlock; and when all is calm, a channel whose sensors are well comes to run, and stays so.
 *
 * The state machine is the firmware's own: transitions.cpp writes it from firmware/core/state.c. What
 * is fresh is link.c's is_fresh, the count is gateway.cpp's, what is asked is drive.cpp's decide, each
 * by hand. Shortened: the watchdog, 25 periods in the firmware. Assumed: no frame stays
 * on its way longer than DELAY periods; counters of three bits cannot tell an older one. */
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

frame wish; /* plant -> gateway: the newest alone */
frame bus[2];

/* ECU */
byte state = BOOT, fault, since;
bool heard;
byte last_count;
/* what the plant and the gateway know of it */
byte seen_state = BOOT, seen_fault, count;
/* ghosts: what the properties are about */
byte followed_age;          /* of the command it runs on */
bool cleared = true, armed; /* since the last fault */

#define ahead(new, old) ((new + 8 - old) % 8)

inline forget(f) { f.request = NOTHING; f.fault = 0; f.count = 0; f.age = 0 }

/* Who comes back has been away for longer than any frame is on its way. */
inline clear_wires() { forget(wish); forget(bus[0]); forget(bus[1]) }

inline copy(to, from) {
  to.request = from.request; to.fault = from.fault; to.count = from.count; to.age = from.age
}

/* ---- plant: components/plant/drive.cpp, with a controller that always wants to move ---- */

inline decide() {
  if
  :: seen_state == BOOT -> wish.request = COMMIT /* its gains */
  :: seen_state == IDLE -> wish.request = ARM
  :: seen_state == ARMED || seen_state == RUNNING -> wish.request = SETPOINT
  :: seen_state == FAULT && seen_fault == SILENCE -> wish.request = CLEAR; wish.fault = seen_fault
  :: seen_state == FAULT && seen_fault != SILENCE -> wish.request = OFF
  fi;
  wish.age = 0
}

active proctype plant() {
  do
  :: atomic { turn == 0 ->
       if
       :: decide()
       :: !calm /* late, dead, or stopped */
       :: !calm -> seen_state = BOOT /* it comes back and knows nothing */
       fi;
       turn = 1 }
  od
}

/* ---- gateway: hal/can/gateway.cpp ---- */

inline send(f) {
  count = (count + 1) % 8;
  copy(f, wish); f.count = count; forget(wish)
}

active proctype gateway() {
  do
  :: atomic { turn == 1 ->
       if
       :: wish.request != NOTHING && bus[0].request == NOTHING ->
          send(bus[0])
       :: wish.request != NOTHING && bus[0].request != NOTHING && bus[1].request == NOTHING ->
          send(bus[1])
       :: wish.request == NOTHING || (bus[0].request != NOTHING && bus[1].request != NOTHING)
       :: !calm                                  /* late: the newest wish waits, not a row of them */
       :: !calm -> clear_wires(); count = 0 /* it comes back */
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
        assert(fault != SENSOR); /* nobody has asked for that */
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
        assert(cleared && armed);        /* clear, arm, and only then a set-point */
        assert(f.age <= followed_age);   /* never back to an older command */
        since = 0; followed_age = f.age
     :: else
     fi
  fi
}

/* COMMIT stands for a set of gains, which carries no counter: it moves nothing. */
inline hear(f) {
  if
  :: f.request == COMMIT -> follow(f)
  :: f.request != COMMIT &&
     (!heard || (ahead(f.count, last_count) > 0 && ahead(f.count, last_count) < LATE)) ->
     heard = true; last_count = f.count;
     follow(f)
  :: else /* late or repeated */
  fi
}

/* The first cause stays. */
inline trip(cause) {
  if
  :: state != FAULT ->
     take(TRIP);
     if :: state == FAULT -> fault = cause; cleared = false; armed = false :: else fi
  :: else
  fi
}

inline reset() {
  state = BOOT; fault = NONE; since = 0; heard = false; last_count = 0;
  followed_age = 0; cleared = true; armed = false; clear_wires()
}

inline period() {
  if
  :: (state == ARMED || state == RUNNING) && since >= WATCHDOG -> trip(SILENCE)
  :: (state == ARMED || state == RUNNING) && since < WATCHDOG -> since++
  :: else
  fi;
  followed_age = (followed_age < 15 -> followed_age + 1 : 15);
  /* it runs only on a fresh command, and only after what has to come before */
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
       if :: seen_state = state; seen_fault = fault :: !calm /* its STATUS is lost */ fi;
       if :: calm :: calm = true :: !calm fi;
       turn = 0 }
  od
}

/* ---- bus ---- */

inline older(f) {
  if
  :: f.request != NOTHING -> f.age++; if :: f.age > DELAY -> forget(f) :: else fi
  :: else
  fi
}

active proctype wire() {
  do
  :: atomic { turn == 2 ->
       if
       :: bus[0].request != NOTHING -> hear(bus[0]); forget(bus[0])
       :: bus[0].request != NOTHING && !calm -> hear(bus[0])     /* it comes once more */
       :: bus[0].request != NOTHING && !calm -> forget(bus[0])   /* lost */
       :: bus[1].request != NOTHING -> hear(bus[1]); forget(bus[1]) /* overtakes */
       :: !calm || (bus[0].request == NOTHING && bus[1].request == NOTHING)
       fi;
       if :: calm && bus[1].request != NOTHING -> hear(bus[1]); forget(bus[1]) :: else fi;
       older(bus[0]); older(bus[1]); older(wish);
       turn = 3 }
  od
}

#define well (calm && fault != SENSOR)
ltl comes_to_run { [] (well -> <> (state == RUNNING)) }
ltl stays_running { [] (well -> <> [] (state == RUNNING)) }
