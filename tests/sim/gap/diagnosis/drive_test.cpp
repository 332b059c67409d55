#include "sim/gap/residuals/drives.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <set>

#include "sim/gap/diagnosis/diagnose.hpp"
#include "tests/sim/gap/diagnosis/light_drive.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::diagnosis;
using namespace sim::residuals;

namespace {

/// Friction of a slide in N s/m and N.
struct Friction {
  double viscous, coulomb, extra_forwards;
};

erp::Robot slide(erp::DriveControl control) {
  erp::Robot robot;
  robot.name = "bench";
  erp::Drive drive;
  drive.name = "z", drive.control = control, drive.gain = 30;
  drive.load = {erp::Slide{{}, 40, 0.01, 1e-6}};
  robot.drives = {drive};
  return robot;
}

/// Simulates a mass with the force gain · u, held for 1 ms. A proportional-derivative controller
/// follows a sum of sines. Friction is a steep tanh. The integrator's step is a twentieth of the
/// row period.
recording::Table recorded(const Friction& f, double seconds, double angular_frequency) {
  constexpr double mass = 40, gain = 30, row_s = 1e-3;
  recording::Table table;
  for (const char* name : {"time_s", "z.control_V", "z.position_m"})
    table.columns.push_back({name, {}});
  double x = 0, v = 0;
  for (int k = 0; k < static_cast<int>(seconds / row_s); ++k) {
    const double t = k * row_s, desired = 0.05 * std::sin(angular_frequency * t) +
                                          0.02 * std::sin(2.7 * angular_frequency * t);
    const double reading = 1e-6 * std::round(x / 1e-6), u = 400 * (desired - reading) - 30 * v;
    table.columns[0].values.push_back(t), table.columns[1].values.push_back(u);
    table.columns[2].values.push_back(reading);
    for (int n = 0; n < 20; ++n) {
      const double friction =
          f.viscous * v + (f.coulomb + (v > 0 ? f.extra_forwards : 0)) * std::tanh(v / 1e-4);
      v += (gain * u - friction) / mass * row_s / 20, x += v * row_s / 20;
    }
  }
  return table;
}

/// Defects of a bench: a current-controlled motor, a gearbox, a compliant shaft and a load, with
/// sensors at both ends.
struct Bench {
  double gear_dry_Nm = 0, load_dry_Nm = 0;
  double stiffness_loss = 0;  ///< relative
  double play_rad = 0;
};

erp::Robot two_ends() {
  erp::Robot robot;
  robot.name = "bench";
  erp::MotorType motor;
  motor.name = "m", motor.resistance_ohm = 1, motor.inductance_H = 1e-4;
  motor.torque_Nm_per_A = motor.back_emf_V_s_per_rad = 0.05, motor.gear_ratio = 50;
  motor.gear_efficiency = 1, motor.rotor_inertia_kg_m2 = 4e-6, motor.supply_V = 24;
  robot.motor_types = {motor};
  erp::Drive drive;
  drive.name = "arm", drive.control = erp::DriveControl::current, drive.gain = 1, drive.motor = "m";
  drive.stiffness_Nm_per_rad = 60, drive.damping_Nm_s_per_rad = 0.1;
  drive.load = {erp::Shaft{{}, 0.05, 0}};
  drive.sensors = {erp::LoadEncoder{}, erp::TorqueSensor{{}, 0.01}};
  robot.drives = {drive};
  return robot;
}

recording::Table recorded(const Bench& b, double seconds, double angular_frequency) {
  constexpr double n = 50, torque = 0.05, rotor = 4e-6 * n * n, inertia = 0.05, row_s = 1e-3;
  constexpr int steps = 50;
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise;
  recording::Table table;
  for (const char* name :
       {"time_s", "arm.control_V", "arm.position_rad", "arm.load_rad", "arm.torque_Nm"})
    table.columns.push_back({name, {}});
  double x = 0, v = 0, q = 0, w = 0, transmitted_Nm = 0;
  for (int k = 0; k < static_cast<int>(seconds / row_s); ++k) {
    const double t = k * row_s, desired = std::sin(angular_frequency * t) +
                                          0.4 * std::sin(2.7 * angular_frequency * t);
    const double u = 3 * (desired - x) - 0.3 * v;
    const double row[] = {t, u, x + 2e-5 * noise(random), q + 2e-5 * noise(random),
                          transmitted_Nm + 0.01 * noise(random)};
    for (std::size_t c = 0; c < 5; ++c) table.columns[c].values.push_back(row[c]);
    for (int s = 0; s < steps; ++s) {
      const double twist = x - q, half_play_rad = b.play_rad / 2, h = row_s / steps;
      const double stretch_rad =
          std::max(0.0, twist - half_play_rad) + std::min(0.0, twist + half_play_rad);
      transmitted_Nm =
          stretch_rad == 0 ? 0 : 60 * (1 - b.stiffness_loss) * stretch_rad + 0.1 * (v - w);
      v += (n * torque * u - transmitted_Nm - b.gear_dry_Nm * std::tanh(v / 1e-3)) / rotor * h;
      w += (transmitted_Nm - b.load_dry_Nm * std::tanh(w / 1e-3)) / inertia * h;
      x += v * h, q += w * h;
    }
  }
  return table;
}

double value_of(const Diagnosis& d, const char* type) {
  for (const IdentifiedEffect& n : d.answer)
    if (n.type == type) return n.values[0];
  return 0;
}

Diagnosis diagnosed(const erp::Robot& drives, const std::vector<recording::Table>& tables) {
  const erp::Robot robot = as_chains(drives);
  std::vector<Episode> episodes;
  std::vector<std::string> remarks;
  for (const auto& table : tables)
    episodes.push_back(lay_out(table, robot, std::to_string(episodes.size()), remarks));
  return diagnose(robot, episodes);
}

std::set<std::string> types_of(const Diagnosis& d) {
  std::set<std::string> types;
  for (const IdentifiedEffect& n : d.answer) types.insert(n.type);
  return types;
}

}  // namespace

TEST_CASE(
    "a slide without friction has no gap, and viscous and Coulomb friction are identified within "
    "3 %") {
  const auto runs = [](const Friction& f) {
    return std::vector{recorded(f, 8, 3), recorded(f, 8, 4), recorded(f, 8, 5)};
  };
  const erp::Robot robot = slide(erp::DriveControl::force);
  CHECK(diagnosed(robot, runs({0, 0, 0})).verdict == Verdict::no_gap);
  const Diagnosis d = diagnosed(robot, runs({80, 12, 0}));
  CHECK(d.verdict == Verdict::supported);
  CHECK(types_of(d) == std::set<std::string>{"gearbox_coulomb", "gearbox_viscous"});
  for (const IdentifiedEffect& n : d.answer)  // on the shaft: N m_per_rad, N s/m m_per_rad²
    CHECK(n.values[0] == Approx(n.type == "gearbox_viscous" ? 80e-4 : 12e-2).epsilon(0.03));
  CHECK(d.channels[0].after < 0.02 * d.channels[0].driven_by);
}

TEST_CASE(
    "asymmetric friction is attributed to the gearbox, not to a current sensor that the drive "
    "lacks") {
  const Friction f{80, 12, 6};
  const Diagnosis d = diagnosed(slide(erp::DriveControl::force),
                                {recorded(f, 8, 3), recorded(f, 8, 4), recorded(f, 8, 5)});
  CHECK(d.verdict == Verdict::supported);
  CHECK(types_of(d) ==
        std::set<std::string>{"gearbox_asymmetric", "gearbox_coulomb", "gearbox_viscous"});
  for (const IdentifiedEffect& n : d.ranked) CHECK_FALSE(n.type.starts_with("sensor_current"));
}

TEST_CASE("current control sets the current of the actuator chain, voltage control its voltage") {
  erp::Robot robot = slide(erp::DriveControl::current);
  erp::MotorType motor;
  motor.name = "m", motor.resistance_ohm = 1, motor.inductance_H = 1e-3;
  motor.torque_Nm_per_A = motor.back_emf_V_s_per_rad = 0.1, motor.gear_ratio = 3;
  motor.gear_efficiency = 1, motor.rotor_inertia_kg_m2 = 1e-5;
  robot.motor_types = {motor}, robot.drives[0].motor = "m", robot.drives[0].gain = 2;
  const erp::Robot chains = as_chains(robot);
  REQUIRE(chains.actuators.size() == 1);
  CHECK(chains.motor_of(chains.actuators[0]).gear_inertia_kg_m2 == Approx(40e-4));
  const Signal u{1, 3, 5}, x{0, 0.01, 0.03};
  const auto by_current = drive_signals(robot.drives[0], {u, x});
  CHECK(by_current.current_A[1] == Approx(4));  // 2 A/V, mean of 1 V and 3 V
  CHECK(by_current.shaft_rad[2] == Approx(3));
  CHECK(by_current.current_around);
  robot.drives[0].control = erp::DriveControl::voltage;
  const auto by_voltage = drive_signals(robot.drives[0], {u, x, {7, 8, 9}});
  CHECK(by_voltage.voltage_V[2] == Approx(6));
  CHECK(by_voltage.current_A[2] == 9);
  CHECK_FALSE(by_voltage.current_around);
}

TEST_CASE(
    "with sensors at both ends gearbox friction, load friction, stiffness and backlash are "
    "identified "
    "within 5 %") {
  const auto found = [](const Bench& bench) {
    return diagnosed(two_ends(),
                     {recorded(bench, 8, 3), recorded(bench, 8, 4), recorded(bench, 8, 5)});
  };
  CHECK(found({}).verdict == Verdict::no_gap);
  const auto check_single = [&](const Bench& bench, const std::string& type, double size) {
    const Diagnosis d = found(bench);
    INFO(type);
    CHECK(types_of(d) == std::set{type});
    if (!d.answer.empty()) CHECK(d.answer[0].values[0] == Approx(size).epsilon(0.05));
  };
  check_single({.gear_dry_Nm = 0.3}, "gearbox_coulomb", 0.3);
  check_single({.load_dry_Nm = 0.3}, "joint_coulomb", 0.3);
  check_single({.stiffness_loss = 0.3}, "tendon_stiffness", -0.3);
  check_single({.play_rad = 0.02}, "gearbox_backlash", 0.02);
}

TEST_CASE("viscous, Coulomb and asymmetric friction are identified in the EMPS recordings") {
  const char* data = std::getenv("ERP_DATA_DIR");
  if (!data || !std::filesystem::exists(std::string(data) + "/emps")) {
    WARN("ERP_DATA_DIR/emps is missing: tests/README.md lists its source");
    return;
  }
  std::vector<recording::Table> tables;
  for (const char* file : {"/emps/estimation.csv", "/emps/validation.csv"})
    tables.push_back(recording::read_table(data + std::string(file)));
  const Diagnosis d = diagnosed(erp::read_robot(rigs::config("drive/robot.xml")), tables);
  CHECK(d.verdict == Verdict::supported);
  CHECK(types_of(d) ==
        std::set<std::string>{"gearbox_asymmetric", "gearbox_coulomb", "gearbox_viscous"});
  CHECK(d.channels[0].before > 0.6 * d.channels[0].driven_by);
  CHECK(d.channels[0].after < 0.036 * d.channels[0].driven_by);
}

TEST_CASE(
    "friction of a drive without noise is identified within 2 %, with and without a constant "
    "load") {
  for (const double load_Nm : {0.0, 3e-4}) {
    INFO("load " << load_Nm << " Nm");
    const Diagnosis d =
        diagnosed(light_drive::description(), light_drive::of_sines({.load_Nm = load_Nm}));
    CHECK(d.verdict == Verdict::supported);
    CHECK(value_of(d, "gearbox_coulomb") == Approx(3e-3).epsilon(0.02));
    CHECK(value_of(d, "gearbox_viscous") == Approx(3e-5).epsilon(0.02));
    CHECK(value_of(d, "gearbox_asymmetric") == Approx(load_Nm).margin(2e-5));
    CHECK(value_of(d, "motor_torque_constant") == 0);
  }
}

TEST_CASE("friction is identified within 2 % from six recordings of one steady speed each") {
  const Diagnosis d =
      diagnosed(light_drive::description(),
                light_drive::at_steady_speeds({}, {.seconds = 4, .noise_rad = 1e-5}));
  CHECK(d.verdict == Verdict::supported);
  CHECK(types_of(d) == std::set<std::string>{"gearbox_coulomb", "gearbox_viscous"});
  CHECK(value_of(d, "gearbox_coulomb") == Approx(3e-3).epsilon(0.02));
  CHECK(value_of(d, "gearbox_viscous") == Approx(3e-5).epsilon(0.02));
}

TEST_CASE("a random torque does not cause an error of the torque constant") {
  const light_drive::Light light{.load_Nm = 3e-4, .disturbance_Nm = 3e-4};
  const Diagnosis d = diagnosed(
      light_drive::description(),
      light_drive::at_steady_speeds(light, {.period_s = 5e-3, .seconds = 4, .noise_rad = 1e-5}));
  CHECK(d.verdict == Verdict::supported);
  CHECK(types_of(d) ==
        std::set<std::string>{"gearbox_asymmetric", "gearbox_coulomb", "gearbox_viscous"});
  const std::map<std::string, double> truth{{"gearbox_asymmetric", light.load_Nm},
                                            {"gearbox_coulomb", light.coulomb_Nm},
                                            {"gearbox_viscous", light.viscous_Nm_s}};
  for (const auto& n : d.answer) {
    INFO(n.type << " " << n.values[0]);
    CHECK(n.intervals[0].low < truth.at(n.type));
    CHECK(n.intervals[0].high > truth.at(n.type));
  }
}

TEST_CASE(
    "with rows of 20 ms the friction of a drive whose shaft reverses within few rows is not "
    "identifiable") {
  const Diagnosis d =
      diagnosed(light_drive::description(), light_drive::of_sines({}, {.period_s = 0.02}));
  CHECK(d.verdict == Verdict::not_identifiable);
  CHECK(std::ranges::any_of(
      d.warnings, [](const std::string& w) { return w.find("turned back") != std::string::npos; }));
}
