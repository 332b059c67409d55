#include <catch2/catch.hpp>
#include <random>

#include "tests/firmware/core/channel.hpp"

// Faulty sensors must trip; working sensors with unusual readings must not.
using namespace firmware;

namespace {

/// A channel driven at 3 V, its shaft at 2 rad/s according to the motor equation, with noise on its
/// converters. Each reading can be replaced.
struct TurningMotor {
  ecu_channel channel = in_state(ECU_STATE_RUNNING, fitted_gains());
  std::mt19937 random{1};
  std::normal_distribution<float> noise{0, 1};
  float shaft_rad = 0, current_A = 0.1f, tension_N = 20, speed_rad_per_s = 2;
  ecu_inputs last_inputs{};

  ecu_inputs read() {
    const Gains g = fitted_gains();
    shaft_rad += speed_rad_per_s * ECU_PERIOD_S;
    return {std::int32_t(shaft_rad / g[ECU_PARAMETER_SHAFT_SCALE]),
            std::int16_t(current_A / g[ECU_PARAMETER_CURRENT_SCALE] + 4 * noise(random)),
            std::uint16_t(tension_N / g[ECU_PARAMETER_TENSION_SCALE] + 410 + noise(random)),
            std::int32_t((30 - shaft_rad) / g[ECU_PARAMETER_WIPER_SCALE] + noise(random)),
            600,
            2400};
  }

  /// Continues with one reading changed; returns the tick of the trip, 0: no trip.
  template <class Change>
  int trip_tick(int ticks, Change change) {
    for (int k = 1; k <= ticks; ++k) {
      ecu_command(&channel, ECU_REQUEST_VOLTAGE, 3000);
      ecu_inputs inputs = read();
      change(inputs);
      tick(channel, inputs);
      last_inputs = inputs;
      if (channel.state == ECU_STATE_FAULT) return k;
    }
    return 0;
  }
  int run_unchanged(int ticks) {
    return trip_tick(ticks, [](ecu_inputs&) {});
  }
};

}  // namespace

TEST_CASE("working sensors that agree do not trip") {
  TurningMotor motor;
  CHECK(motor.run_unchanged(5000) == 0);
}

TEST_CASE("an open or shorted force sensor trips at the third sample") {
  for (const std::uint16_t rail : {std::uint16_t(4095), std::uint16_t(0), std::uint16_t(200)}) {
    INFO("at " << rail);
    TurningMotor motor;
    motor.run_unchanged(100);
    CHECK(motor.trip_tick(10, [&](ecu_inputs& in) { in.tension_counts = rail; }) == 3);
    CHECK(motor.channel.fault == ECU_FAULT_SENSOR_RANGE);
    CHECK(motor.channel.request == ECU_REQUEST_OFF);
    CHECK(motor.channel.sensed.tension_N == Approx(20).margin(0.3));
  }
}

TEST_CASE("a reading at or slightly below the live zero is tension 0") {
  TurningMotor motor;
  motor.tension_N = -1;
  CHECK(motor.run_unchanged(500) == 0);
  CHECK(motor.channel.sensed.tension_N == 0);
}

TEST_CASE("a constant reading of 0 without live zero is a slack tendon, not a stuck sensor") {
  TurningMotor motor;
  Gains gains = fitted_gains();
  gains[ECU_PARAMETER_TENSION_ZERO] = 0;
  load(motor.channel, gains);
  CHECK(motor.trip_tick(500, [](ecu_inputs& in) { in.tension_counts = 0; }) == 0);
}

TEST_CASE("a frozen converter trips after 100 ms of rotation") {
  TurningMotor current, tension;
  CHECK(current.trip_tick(100, [](ecu_inputs& in) { in.current_counts = 25; }) == 51);
  CHECK(current.channel.fault == ECU_FAULT_SENSOR_STUCK);
  CHECK(tension.trip_tick(100, [](ecu_inputs& in) { in.tension_counts = 800; }) == 51);
  CHECK(tension.channel.fault == ECU_FAULT_SENSOR_STUCK);
}

TEST_CASE("a constant reading is accepted while the shaft is at rest") {
  TurningMotor motor;
  motor.speed_rad_per_s = 0.4f;
  motor.trip_tick(500, [](ecu_inputs& in) { in.tension_counts = 800; });
  CHECK(motor.channel.fault != ECU_FAULT_SENSOR_STUCK);
}

TEST_CASE("a constant reading is accepted if the stuck check is disabled") {
  TurningMotor motor;
  Gains gains = fitted_gains();
  gains[ECU_PARAMETER_TENSION_STUCK_SPEED] = 0;
  load(motor.channel, gains);
  CHECK(motor.trip_tick(500, [](ecu_inputs& in) { in.tension_counts = 800; }) == 0);
}

TEST_CASE("an encoder with a lost phase trips within 50 ms of driving, in both directions") {
  for (const bool winding_up : {true, false}) {
    TurningMotor motor;
    motor.speed_rad_per_s = winding_up ? 2.0f : -2.0f;
    Gains gains = fitted_gains();
    gains[ECU_PARAMETER_WIPER_TOLERANCE] = 0;  // only the motor equation can detect it
    load(motor.channel, gains);
    int k = 0;
    const auto jitter = [&](ecu_inputs& in) { in.encoder_counts = 1000 + (++k % 2); };
    const auto command = winding_up ? 3000 : -3000;
    int tripped = 0;
    for (int n = 1; n < 60 && !tripped; ++n) {
      ecu_command(&motor.channel, ECU_REQUEST_VOLTAGE, command);
      ecu_inputs in = motor.read();
      jitter(in);
      tick(motor.channel, in);
      if (motor.channel.state == ECU_STATE_FAULT) tripped = n;
    }
    CHECK(tripped == 26);
    CHECK(motor.channel.fault == ECU_FAULT_ENCODER);
  }
}

TEST_CASE("a motor stalled at its current limit is not reported as an encoder fault") {
  for (const float resistance : {0.516f, 0.88f}) {  // the gains contain 0.516
    TurningMotor motor;
    motor.speed_rad_per_s = 0;
    int tripped = 0;
    for (int n = 0; n < 200 && !tripped; ++n) {
      ecu_command(&motor.channel, ECU_REQUEST_VOLTAGE, 12000);
      motor.current_A = 12.0f * float(motor.channel.duty) / ECU_DUTY_MAX / resistance;
      const ecu_inputs in = motor.read();
      tick(motor.channel, in);
      if (motor.channel.state == ECU_STATE_FAULT) tripped = n;
    }
    INFO("at " << resistance << " ohm");
    CHECK(tripped == 0);
  }
}

TEST_CASE("an encoder that slips is detected by the potentiometer") {
  TurningMotor motor;
  motor.run_unchanged(100);
  const float scale = fitted_gains()[ECU_PARAMETER_SHAFT_SCALE];
  const auto slipped = [&](ecu_inputs& in) { in.encoder_counts -= std::int32_t(0.2f / scale); };
  CHECK(motor.trip_tick(100, slipped) == 25);
  CHECK(motor.channel.fault == ECU_FAULT_POTENTIOMETER);
  ecu_command(&motor.channel, ECU_REQUEST_CLEAR, motor.channel.fault);
  CHECK(motor.channel.state == ECU_STATE_IDLE);
  CHECK(motor.trip_tick(100, slipped) == 25);  // the reference of the potentiometer is kept
}

TEST_CASE("an encoder that slips does not raise the current limit") {
  TurningMotor motor;
  motor.run_unchanged(100);
  const float before_rad_per_s = motor.channel.sensed.speed_rad_per_s;
  ecu_inputs in = motor.read();
  in.encoder_counts -= 41721 / 6;  // 0.167 rad in 2 ms; without load the motor reaches 8.2 rad/s
  ecu_command(&motor.channel, ECU_REQUEST_LENGTH, in.encoder_counts + 41721);
  tick(motor.channel, in);
  CHECK(motor.channel.sensed.speed_rad_per_s == before_rad_per_s);
  const float drop_V = 12.0f * float(motor.channel.duty) / ECU_DUTY_MAX - 1.472f * before_rad_per_s;
  CHECK(drop_V / 0.516f == Approx(4).margin(0.05));  // the limit
}

TEST_CASE("a speed beyond the motor's range trips at the third sample") {
  TurningMotor motor;
  motor.run_unchanged(100);
  int k = 0;
  CHECK(motor.trip_tick(10, [&](ecu_inputs& in) { in.encoder_counts += ++k * 5000; }) == 3);
  CHECK(motor.channel.fault == ECU_FAULT_SENSOR_RANGE);
}

TEST_CASE("a potentiometer beyond its range is ignored") {
  TurningMotor motor;
  CHECK(motor.trip_tick(300, [](ecu_inputs& in) { in.potentiometer_counts = 4095; }) == 0);
}
