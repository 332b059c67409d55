#include "sim/gap/estimation/as_built.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "sim/gap/residuals/noise_floor.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::estimation;
using blind_recording::hinge_rig;

namespace {

/// Recordings of a rig with other constants and hidden effects. They are simulated with the
/// equations of the blind cases and arranged for the nominal rig.
std::vector<sim::residuals::Episode> recordings_of(
    const erp::Robot& built, double seconds = 10,
    const sim::blind::Case& hidden = blind_recording::nothing_hidden()) {
  std::vector<sim::residuals::Episode> all;
  std::vector<std::string> remarks;
  for (int k = 0; k < 3; ++k)
    all.push_back(sim::residuals::lay_out(
        sim::blind::record(built, hidden, sim::excitation(built, k, seconds, 5), std::uint64_t(k)),
        hinge_rig(), "recording " + std::to_string(k + 1), remarks));
  return all;
}

std::size_t index_of(const AsBuilt& built, const std::string& on, const std::string& name) {
  const auto& all = built.uncertain.constants;
  const auto found =
      std::ranges::find_if(all, [&](const Constant& c) { return c.on == on && c.name == name; });
  REQUIRE(found != all.end());
  return std::size_t(found - all.begin());
}

double value_of(const AsBuilt& built, const std::string& on, const std::string& name) {
  const std::size_t k = index_of(built, on, name);
  return built.uncertain.constants[k].value(built.estimate.point.x[k]);
}

void check_within(const AsBuilt& built, const std::string& on, const std::string& name,
                  double truth) {
  INFO(on << " " << name);
  const std::size_t k = index_of(built, on, name);
  const Constant& c = built.uncertain.constants[k];
  const double half = 2.6 * built.estimate.sigma(k) * c.tolerance + 0.01 * truth;
  CHECK(std::abs(value_of(built, on, name) - truth) < half);
}

/// Multiplies torque and back-EMF constant of all motors by a factor.
void change_magnet(erp::Robot& robot, double factor) {
  erp::MotorType& motor = robot.motor_types[0];
  motor.torque_Nm_per_A *= factor, motor.back_emf_V_s_per_rad *= factor;
}

}  // namespace

TEST_CASE(
    "constants 3 to 6 % off are estimated within their intervals and leave noise at each stage") {
  erp::Robot built = hinge_rig();
  built.motor_types[0].resistance_ohm *= 1.06;
  built.motor_types[0].rotor_inertia_kg_m2 *= 1.05;
  for (erp::Actuator& a : built.actuators) a.spindle.radius_m *= 1.03;
  built.skeletons[0].bodies[1].mass_kg *= 0.95;
  const auto recordings = recordings_of(built);
  const AsBuilt found = calibrated(hinge_rig(), recordings);
  for (const char* on : {"flexor", "extensor"}) {
    check_within(found, on, "resistance_ohm", 1.06 * 0.516);
    check_within(found, on, "rotor_inertia_kg_m2", 1.05 * 14.5e-7);
    check_within(found, on, "torque_Nm_per_A", 11.5e-3);
    // A larger spindle with a larger moment arm and a softer spring gives nearly the same
    // residuals.
    CHECK(value_of(found, on, "radius_m") / value_of(found, on, "moment_arm") ==
          Approx(1.03 * 0.0045).epsilon(0.005));
  }
  check_within(found, "forearm", "mass", 0.95);
  for (const double square : found.estimate.mean_square) CHECK(square < 1.3);
  CHECK(found.beyond_tolerance.empty());
}

TEST_CASE("a stiffness 30 % above nominal is estimated and written to the calibrated robot") {
  erp::Robot built = hinge_rig();
  for (erp::Actuator& a : built.actuators) a.tendon.stiffness_N_per_m *= 1.3;
  const auto recordings = recordings_of(built);
  const AsBuilt found = calibrated(hinge_rig(), recordings);
  REQUIRE_FALSE(found.beyond_tolerance.empty());  // six tolerances
  CHECK(found.uncertain.constants[found.beyond_tolerance[0]].name == "stiffness_N_per_m");
  for (const erp::Actuator& a : found.robot.actuators)
    CHECK(a.tendon.stiffness_N_per_m == Approx(value_of(found, a.name, "stiffness_N_per_m")));
  CHECK(found.robot.actuators[0].tendon.stiffness_N_per_m == Approx(7800).epsilon(0.03));
}

TEST_CASE(
    "the standard error of a constant that recordings determine only jointly with others is above "
    "0.3 "
    "tolerances") {
  const auto recordings = recordings_of(hinge_rig());
  const AsBuilt found = calibrated(hinge_rig(), recordings);
  for (const char* on : {"flexor", "extensor"}) {
    // With all torques, forces and masses 1 % larger the motion is the same.
    const std::size_t k = index_of(found, on, "current_gain");
    CHECK(found.estimate.sigma(k) > 0.3);
    CHECK(std::abs(found.estimate.point.x[k]) < 1);
  }
}

TEST_CASE("a viscous friction 100 times its nominal value is identified as that constant") {
  erp::Robot built = hinge_rig();
  built.motor_types[0].resistance_ohm *= 1.02, built.actuators[0].spindle.radius_m *= 0.99;
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.channels[0].viscous = 0.05;  // 100 times
  const auto recordings = recordings_of(built, 10, blind);
  const std::span<const sim::residuals::Episode> each(recordings);
  const AsBuilt found = as_built(hinge_rig(), each.first(2), each.last(1));
  CHECK(found.estimate.point.effects.empty());
  REQUIRE(found.beyond_tolerance.size() == 1);
  CHECK(found.beyond_tolerance[0] == index_of(found, "flexor", "gear_viscous_Nm_s_per_rad"));
  check_within(found, "flexor", "gear_viscous_Nm_s_per_rad", 0.0505);
}

TEST_CASE(
    "a forearm that is 40 % too light is identified, with the centre of mass as the alternative") {
  erp::Robot built = hinge_rig();
  built.motor_types[0].resistance_ohm *= 1.02, change_magnet(built, 0.99);
  built.actuators[0].spindle.radius_m *= 0.99, built.actuators[1].tendon.stiffness_N_per_m *= 1.05;
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.bodies["forearm"].mass = -0.4;
  const auto recordings = recordings_of(built, 10, blind);
  const std::span<const sim::residuals::Episode> each(recordings);
  const AsBuilt found = as_built(hinge_rig(), each.first(2), each.last(1));
  REQUIRE(found.beyond_tolerance.size() == 1);
  CHECK(found.beyond_tolerance[0] == index_of(found, "forearm", "mass"));
  check_within(found, "forearm", "mass", 0.6);
  REQUIRE(found.alternatives[0].size() == 1);
  CHECK(sim::effects::name_of(found.alternatives[0][0].effect) == "skeleton_com on forearm");
}

TEST_CASE("tendon creep is identified with constants 2 to 3 % off") {
  erp::Robot built = hinge_rig();
  built.motor_types[0].resistance_ohm *= 1.03, change_magnet(built, 0.98);
  built.actuators[0].spindle.radius_m *= 1.02, built.actuators[1].tendon.stiffness_N_per_m *= 0.97;
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.channels[1].creep_N_per_m = 1500,
  blind.hidden_effects.channels[1].creep_s = 2;  // extensor
  const auto recordings = recordings_of(built, 10, blind);
  const std::span<const sim::residuals::Episode> each(recordings);
  const AsBuilt found = as_built(hinge_rig(), each.first(2), each.last(1));
  REQUIRE(found.estimate.point.effects.size() == 1);
  CHECK(sim::effects::name_of(found.estimate.point.effects[0]) == "tendon_creep on extensor");
}

TEST_CASE("a joint sensor's gain is identified although both moment arms could nearly replace it") {
  erp::Robot built = hinge_rig();
  built.motor_types[0].resistance_ohm *= 1.02, change_magnet(built, 0.99);
  built.actuators[0].spindle.radius_m *= 0.99, built.actuators[1].tendon.stiffness_N_per_m *= 1.05;
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.joints[0].angle.gain = -0.095;
  const auto recordings = recordings_of(built, 10, blind);
  const std::span<const sim::residuals::Episode> each(recordings);
  const AsBuilt found = as_built(hinge_rig(), each.first(2), each.last(1));
  REQUIRE(found.estimate.point.effects.size() == 1);
  CHECK(sim::effects::name_of(found.estimate.point.effects[0]) == "sensor_joint_gain on elbow");
  CHECK(found.beyond_tolerance.empty());
}

TEST_CASE(
    "joint play, a low-pass of a sensor and a compliant line are identified with constants 2 % "
    "off") {
  struct Hidden {
    const char* name;
    std::function<void(sim::blind::HiddenEffects&)> hide;
  };
  const Hidden each[] = {
      {"joint_play on elbow", [](auto& q) { q.joints[0].play_rad = 0.054; }},
      {"sensor_current_low_pass on flexor", [](auto& q) { q.channels[0].current.lag_s = 0.0092; }},
      {"tendon_kite_line on extensor", [](auto& q) { q.channels[1].line_m_per_N = 7e-5; }}};
  for (const Hidden& hidden : each) {
    INFO(hidden.name);
    auto blind = blind_recording::nothing_hidden();
    hidden.hide(blind.hidden_effects);
    blind.built = sim::blind::as_built(hinge_rig(), 0.02, 41, blind.hidden_effects);
    const auto recordings = blind_recording::episodes(blind, 10);
    const std::span<const sim::residuals::Episode> all(recordings);
    const AsBuilt found = as_built(hinge_rig(), all.first(2), all.last(1));
    CHECK_FALSE(found.has_open_stage);
    REQUIRE(found.estimate.point.effects.size() == 1);
    CHECK(sim::effects::name_of(found.estimate.point.effects[0]) == hidden.name);
  }
}

TEST_CASE(
    "a wrong tendon stiffness is identified as the only cause if all other constants are exact") {
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.channels[0].spring = 0.2;  // flexor
  const auto recordings = recordings_of(hinge_rig(), 10, blind);
  const std::span<const sim::residuals::Episode> each(recordings);
  const AsBuilt found = as_built(hinge_rig(), each.first(2), each.last(1));
  CHECK(found.exact);
  CHECK_FALSE(found.has_open_stage);
  REQUIRE(found.estimate.point.effects.size() == 1);
  CHECK(sim::effects::name_of(found.estimate.point.effects[0]) == "tendon_stiffness on flexor");
}

TEST_CASE("a constant of a withheld type is not estimated") {
  const auto recordings = recordings_of(hinge_rig(), 3);
  const std::span<const sim::residuals::Episode> each(recordings);
  AsBuiltOptions options;
  options.search.withhold = {"motor_resistance"};
  const AsBuilt found = as_built(hinge_rig(), each.first(2), each.last(1), options);
  CHECK(std::ranges::none_of(found.uncertain.constants,
                             [](const Constant& c) { return c.name == "resistance_ohm"; }));
  CHECK(found.estimate.point.effects.empty());
}

TEST_CASE("an estimate that continues another one converges to the same numbers") {
  erp::Robot built = hinge_rig();
  built.motor_types[0].resistance_ohm *= 1.06;
  for (erp::Actuator& a : built.actuators) a.tendon.stiffness_N_per_m *= 0.95;
  const auto recordings = recordings_of(built, 5);
  const erp::Robot nominal = hinge_rig();
  const Estimator estimator(nominal, recordings);
  const Uncertain uncertain{nominal, constants_of(nominal)};
  const Estimate full = estimator.run(uncertain, {});
  EstimateOptions one_iteration;
  one_iteration.iterations = 1;
  const Estimate first_step = Estimator(nominal, recordings, one_iteration).run(uncertain, {});
  const Estimate continued = estimator.continued(uncertain, first_step);
  CHECK((first_step.z - full.z).norm() > 10 * (continued.z - full.z).norm());
  CHECK(continued.cost == Approx(full.cost).margin(0.3));
  for (std::size_t k = 0; k < uncertain.constants.size(); ++k)
    CHECK(continued.point.x[k] == Approx(full.point.x[k]).margin(0.3));
}

TEST_CASE(
    "if only the stage of the flexor's motor is open, the screen returns only effects that change "
    "it") {
  using sim::effects::Stage;
  const auto recordings = recordings_of(hinge_rig(), 5);
  const erp::Robot nominal = hinge_rig();
  const Estimator estimator(nominal, recordings);
  const Uncertain uncertain{nominal, constants_of(nominal)};
  const std::vector<std::string> withhold;
  const Screen screen(estimator, uncertain, withhold);
  const Estimate at = estimator.run(uncertain, {});
  std::vector<bool> open, no_stage;
  for (const auto& r : estimator.residuals().first().residuals) {
    open.push_back(r.stage == Stage::motor && r.on == "flexor");
    no_stage.push_back(false);
  }
  const auto screened = screen.candidates(at, open), all = screen.candidates(at, no_stage);
  REQUIRE_FALSE(screened.empty());
  CHECK(screened.size() < all.size());
  for (const Candidate& c : screened) {
    INFO(sim::effects::name_of(c.start));
    CHECK(c.start.on == "flexor");
    const Stage stage = sim::effects::about(c.start.effect).stage;
    CHECK((stage == Stage::motor || stage == Stage::sensor));
  }
}

TEST_CASE(
    "the rise of noise floors in the first third of recordings equals that in the whole "
    "recordings") {
  const erp::Robot nominal = hinge_rig();
  erp::Robot other = nominal;
  other.motor_types[0].resistance_ohm *= 3;
  for (erp::Actuator& a : other.actuators) a.tendon.stiffness_N_per_m *= 3;
  const auto recordings = recordings_of(nominal);
  constexpr std::uint64_t seed = 1;
  const ResidualVector vector(nominal, recordings, seed, 2);
  for (const double r : vector.floor_ratio(vector.explain(nominal, 2))) CHECK(r == Approx(1));
  const auto floor_ratios = vector.floor_ratio(vector.explain(other, 2));
  for (std::size_t s = 0; s < vector.stages(); ++s) {
    const auto square = [&](const erp::Robot& robot) {  // in whole recordings
      double sum = 0;
      for (const auto& recording : recordings) {
        sim::residuals::Stages stages(robot);
        const auto real = stages.residuals(recording)[s],
                   disturbed = stages.residuals(
                       sim::residuals::resampled_noise(recording, nominal, seed))[s];
        for (std::size_t k = 0; k < real.value.size(); ++k)
          if (const double change = disturbed.value[k] - real.value[k];
              !std::isnan(change) && !banded(real, k) && !banded(disturbed, k))
            sum += change * change;
      }
      return sum;
    };
    CHECK(floor_ratios[s] == Approx(std::sqrt(square(other) / square(nominal))).epsilon(0.1));
  }
  CHECK(*std::ranges::max_element(floor_ratios) > 1.2);
}
