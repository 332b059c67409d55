#include "sim/gap/residuals/stages.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/model/effects/magnitudes.hpp"
#include "tests/sim/rigs.hpp"

namespace effects = sim::effects;
using namespace sim::residuals;

namespace {

using rigs::hinge_rig;

/// The rig with one effect of visible size.
erp::Robot with(const std::string& type) {
  erp::Robot robot = hinge_rig();
  const auto effect = magnitudes::visible(type);
  robot.effects = {effects::written({magnitudes::place_in_rig(effect), effect})};
  return robot;
}

std::map<std::string, double> rms(Stages stages, const Episode& episode) {
  std::map<std::string, double> all;
  for (const Residual& r : stages.residuals(episode)) {
    double square = 0;
    int n = 0;
    for (const double x : r.value)
      if (!std::isnan(x)) square += x * x, ++n;
    all[std::string(effects::word(r.stage)) + " " + r.on] = std::sqrt(square / n);
  }
  return all;
}

/// The episode with 20 ms of missing samples in the middle.
Episode with_a_gap(Episode episode) {
  const auto cut = [&](Signal& signal) {
    if (!signal.empty())
      std::fill_n(signal.begin() + std::ptrdiff_t(episode.rows / 2), 10, recording::not_taken);
  };
  for (ActuatorSignals& s : episode.actuators)
    for (Signal* signal : {&s.voltage_V, &s.current_A, &s.shaft_rad, &s.tension_N}) cut(*signal);
  for (JointSignals& joint : episode.joints) cut(joint.angle_rad);
  return episode;
}

/// An effect and the stages at which it raises the nominal robot's residual.
struct Signature {
  const char* type;
  std::vector<std::string> stages;
};

// Not included: effects that this motion does not excite (stiction, inductance, backlash, an
// attachment that lies on its pulley), effects that cannot be inverted (quantization), and the bus.
const std::vector<Signature> signatures{
    {"motor_resistance", {"motor flexor", "gearbox flexor"}},
    {"motor_torque_constant", {"motor flexor", "gearbox flexor"}},
    {"motor_dead_band", {"motor flexor"}},
    {"motor_supply_sag", {"motor flexor", "gearbox flexor"}},
    {"gearbox_coulomb", {"gearbox flexor"}},
    {"gearbox_asymmetric", {"gearbox flexor"}},
    {"gearbox_viscous", {"gearbox flexor"}},
    {"gearbox_load_dependent", {"gearbox flexor"}},
    {"gearbox_inertia", {"gearbox flexor"}},
    {"gearbox_shaft_compliance", {"tendon flexor"}},
    {"spindle_radius", {"tendon flexor", "gearbox flexor"}},
    {"spindle_layers", {"tendon flexor", "gearbox flexor"}},
    {"spindle_slip", {"tendon flexor"}},
    {"tendon_stiffness", {"tendon flexor"}},
    {"tendon_stiffening", {"tendon flexor"}},
    {"tendon_damping", {"tendon flexor"}},
    {"tendon_creep", {"tendon flexor"}},
    {"tendon_hysteresis", {"tendon flexor"}},
    {"tendon_length_offset", {"tendon flexor"}},
    {"tendon_kite_line", {"tendon flexor"}},
    {"routing_capstan", {"gearbox flexor"}},
    {"routing_pulley_radius", {"tendon flexor", "joint elbow"}},
    {"routing_moment_arm", {"tendon flexor", "joint elbow"}},
    {"joint_coulomb", {"joint elbow"}},
    {"joint_viscous", {"joint elbow"}},
    {"joint_passive_stiffness", {"joint elbow"}},
    {"joint_play", {"tendon flexor", "tendon extensor", "joint elbow"}},
    {"skeleton_mass", {"joint elbow"}},
    {"skeleton_com", {"joint elbow"}},
    {"skeleton_base_tilt", {"joint elbow"}},
    {"sensor_current_offset", {"motor flexor", "gearbox flexor"}},
    {"sensor_current_gain", {"motor flexor", "gearbox flexor"}},
    {"sensor_tension_offset", {"tendon flexor", "gearbox flexor", "joint elbow"}},
    {"sensor_tension_gain", {"tendon flexor", "gearbox flexor", "joint elbow"}},
    {"sensor_shaft_gain", {"motor flexor", "gearbox flexor", "tendon flexor"}},
    {"sensor_joint_offset", {"tendon flexor", "tendon extensor", "joint elbow"}},
};

}  // namespace

TEST_CASE("without effects the residual of each stage is the sensor noise") {
  const auto residuals =
      rms(Stages(hinge_rig()), rig_recording::record(hinge_rig(), hinge_rig(), {}));
  CHECK(residuals.size() == 7);
  for (const auto& [stage, value] : residuals) {
    INFO(stage);
    // Noise, averaged over about ten samples. Motor: 15 mA · 0.516 ohm. Gearbox: 15 mA at the
    // gearbox, and 0.5 mrad differentiated twice. Tendon: 0.05 N, and 0.5 mrad · 25 mm · 6000 N/m.
    const double noise = stage.starts_with("motor")     ? 0.0077
                         : stage.starts_with("gearbox") ? 0.022
                         : stage.starts_with("tendon")  ? 0.09
                                                        : 0.03;
    CHECK(value < noise);
    CHECK(value > noise / 10);
  }
}

TEST_CASE(
    "a winding with twelve times the inductance has residuals below 1.1 times the usual ones") {
  erp::Robot slow = hinge_rig();
  for (auto& motor : slow.motor_types) motor.inductance_H *= 12;
  const auto usual = rms(Stages(hinge_rig()), rig_recording::record(hinge_rig(), hinge_rig(), {}));
  for (const auto& [stage, value] : rms(Stages(slow), rig_recording::record(slow, slow, {}))) {
    INFO(stage);
    CHECK(value < 1.1 * usual.at(stage));
  }
}

TEST_CASE(
    "an effect raises only the residuals of its stages, and no residual of a model with the "
    "effect") {
  const Episode without_effects = rig_recording::record(hinge_rig(), hinge_rig(), {});
  const auto floor = rms(Stages(hinge_rig()), without_effects);
  for (const Signature& signature : signatures) {
    const erp::Robot real = with(signature.type);
    const Episode episode = rig_recording::record(hinge_rig(), real, {});
    const auto nominal = rms(Stages(hinge_rig()), episode), corrected = rms(Stages(real), episode);
    const auto cut = rms(Stages(real), with_a_gap(episode));
    for (const auto& [stage, value] : nominal) {
      INFO(signature.type << " at " << stage << ": " << value / floor.at(stage) << ", with it "
                          << corrected.at(stage) / floor.at(stage) << " times the floor");
      const bool is_affected = std::ranges::count(signature.stages, stage) > 0;
      if (is_affected) CHECK(value > 1.3 * floor.at(stage));
      else CHECK(value < 1.25 * floor.at(stage));
      CHECK(corrected.at(stage) < 1.8 * floor.at(stage));
      CHECK(cut.at(stage) < 2.1 * floor.at(stage));  // hysteresis restarts after a gap
    }
  }
}

namespace {

/// The residual of the flexor's tendon for a spindle radius multiplied by `factor`.
std::vector<double> flexor_residual(const Episode& episode, double factor) {
  erp::Robot robot = hinge_rig();
  robot.actuators[0].spindle.radius_m *= factor;
  Stages stages(robot);
  for (const Residual& r : stages.residuals(episode))
    if (r.stage == effects::Stage::tendon && r.on == "flexor") return r.value;
  return {};
}

}  // namespace

TEST_CASE("the residual of a tendon that becomes taut is a smooth function of the spindle radius") {
  const erp::Robot robot = hinge_rig();
  Episode episode = rig_recording::record(robot, robot, {.seconds = 6});
  const erp::Actuator& flexor = robot.actuators[0];
  const double released_N = 20,
               slack_rad = released_N / flexor.tendon.stiffness_N_per_m / flexor.spindle.radius_m;
  for (double& theta : episode.actuators[0].shaft_rad) theta -= slack_rad;
  std::vector<double> before = flexor_residual(episode, 1);
  double smallest_step = 0, largest_step = 0;
  for (int k = 1; k <= 200; ++k) {
    const std::vector<double> after = flexor_residual(episode, 1 + 2e-6 * k);
    double step = 0;
    for (std::size_t n = 0; n < after.size(); ++n)
      if (!std::isnan(after[n] - before[n])) step = std::max(step, std::abs(after[n] - before[n]));
    smallest_step = k == 1 ? step : std::min(smallest_step, step);
    largest_step = std::max(largest_step, step);
    before = after;
  }
  CHECK(smallest_step > 0);
  CHECK(largest_step < 3 * smallest_step);
}

TEST_CASE(
    "residuals without tensions are computed with the spring's law, residuals without currents "
    "with "
    "the motor's law") {
  Episode episode = rig_recording::record(hinge_rig(), hinge_rig(), {});
  const auto all = rms(Stages(hinge_rig()), episode);
  for (auto& actuator : episode.actuators) actuator.tension_N.clear();
  auto residuals = rms(Stages(hinge_rig()), episode);
  CHECK(residuals.size() == 5);
  CHECK(residuals.at("gearbox flexor") < 1.3 * all.at("gearbox flexor"));
  CHECK(residuals.at("joint elbow") < 1.5 * all.at("joint elbow"));
  for (auto& actuator : episode.actuators) actuator.current_A.clear();
  residuals = rms(Stages(hinge_rig()), episode);
  CHECK(residuals.size() == 3);
  CHECK(residuals.at("gearbox flexor") < 0.022);
  episode.joints[0].angle_rad.clear();
  CHECK(Stages(hinge_rig()).residuals(episode).empty());
}
