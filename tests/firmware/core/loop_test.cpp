#include <catch2/catch.hpp>
#include <cmath>

#include "tests/firmware/core/channel.hpp"
#include "tests/firmware/core/motor.hpp"

using namespace firmware;

namespace {

/// State feedback on (i, w, F) at 500 Hz for TinyMotor on its spring: poles at -40 and
/// -60 s^-1, and the electrical pole at z = 0, by Ackermann's formula on the exact discretisation.
Gains with_force_gains() {
  Gains g = rig_gains();
  g[ECU_PARAMETER_FORCE_K_CURRENT] = -0.00404799f;
  g[ECU_PARAMETER_FORCE_K_SPEED] = -0.574106f;
  g[ECU_PARAMETER_FORCE_K_TENSION] = 0.780457f;
  g[ECU_PARAMETER_FORCE_PREFILTER] = 0.783110f;
  return g;
}

struct Loop {
  ecu_channel channel = in_state(ECU_STATE_ARMED);
  TinyMotor motor;

  Loop() { load(channel, with_force_gains()); }

  /// Holds a set-point for a time; calls `each` with the motor after every period.
  template <class Each>
  void follow(ecu_request request, std::int32_t setpoint, double time_s, Each each) {
    for (int k = 0; k < int(time_s / 0.002 + 0.5); ++k) {
      REQUIRE(ecu_command(&channel, request, setpoint));
      motor.period(tick(channel, motor.read()));
      each((k + 1) * 0.002);
    }
  }
  void follow(ecu_request request, std::int32_t setpoint, double time_s) {
    follow(request, setpoint, time_s, [](double) {});
  }
};

}  // namespace

TEST_CASE(
    "a force step from 2 to 40 N rises as fast as on the paper's robot and stays within its RMS "
    "error") {
  Loop loop;
  loop.follow(ECU_REQUEST_FORCE, 2000, 1.0);
  CHECK(loop.motor.tension_N() == Approx(2).margin(0.3));
  double rise_s = 0, peak_N = 0, sum_N2 = 0;
  int count = 0;
  loop.follow(ECU_REQUEST_FORCE, 40000, 2.0, [&](double t_s) {
    const double F_N = loop.motor.tension_N();
    if (rise_s == 0 && F_N >= 2 + 0.9 * 38) rise_s = t_s;
    peak_N = std::max(peak_N, F_N);
    if (t_s > 1) sum_N2 += (F_N - 40) * (F_N - 40), ++count;
  });
  INFO("rise " << rise_s << " s, peak " << peak_N << " N");
  CHECK(rise_s > 0);
  CHECK(rise_s < 0.318);                     // paper, Fig. 6b
  CHECK(std::sqrt(sum_N2 / count) < 0.236);  // paper, Fig. 6b
  CHECK(peak_N < 42);
}

TEST_CASE("force control decreases the tension from 60 to 10 N within 0.3 N") {
  Loop loop;
  loop.follow(ECU_REQUEST_FORCE, 60000, 1.0);
  loop.follow(ECU_REQUEST_FORCE, 10000, 1.0);
  CHECK(loop.motor.tension_N() == Approx(10).margin(0.3));
}

TEST_CASE("length control against a spring has the steady-state error of a P law under its load") {
  Loop loop;
  const double scale = 2 * TinyMotor::pi / (2048 * 128);
  loop.follow(ECU_REQUEST_LENGTH, std::lround(1.0 / scale), 2.0);
  // At rest kp (1 - shaft) = R i. The current i holds r F, plus or minus friction.
  const double kp = rig_gains()[ECU_PARAMETER_LENGTH_KP],
               load_Nm = TinyMotor::r * loop.motor.tension_N();
  const double rad_per_Nm = TinyMotor::R / (TinyMotor::K * TinyMotor::N * TinyMotor::eta) / kp;
  const double error_rad = 1.0 - loop.motor.shaft_rad;
  CHECK(loop.motor.w_rad_per_s == 0);
  CHECK(error_rad > (load_Nm - TinyMotor::tau_c) * rad_per_Nm - 5e-4);
  CHECK(error_rad < (load_Nm + TinyMotor::tau_c) * rad_per_Nm + 5e-4);
}

TEST_CASE("current control has no steady-state error at standstill") {
  Loop loop;
  // A constant current removes the damping of the back-EMF: the motor oscillates on its spring
  // until friction stops it.
  loop.follow(ECU_REQUEST_CURRENT, 300, 12.0);
  CHECK(loop.motor.w_rad_per_s == Approx(0).margin(1e-3));
  CHECK(loop.motor.i_A == Approx(0.3).margin(0.02));
}

TEST_CASE("the motor current stays within the limit during a full reversal") {
  Loop loop;
  loop.follow(ECU_REQUEST_VOLTAGE, 12000, 0.1);
  loop.follow(ECU_REQUEST_VOLTAGE, -12000, 0.1);
  loop.follow(ECU_REQUEST_VOLTAGE, 12000, 0.1);
  INFO("peak " << loop.motor.peak_A << " A");
  CHECK(loop.motor.peak_A <
        4.5);  // some tenths above the limit of 4 A, because the speed changes within a period
  CHECK(loop.channel.state == ECU_STATE_RUNNING);
}

TEST_CASE("without commands the current is zero within 52 ms") {
  Loop loop;
  loop.follow(ECU_REQUEST_FORCE, 40000, 0.1);
  for (int k = 0; k < 26; ++k) loop.motor.period(tick(loop.channel, loop.motor.read()));
  CHECK(loop.channel.state == ECU_STATE_FAULT);
  CHECK(loop.channel.duty == 0);
}
