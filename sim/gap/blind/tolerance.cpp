#include "sim/gap/blind/tolerance.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>
#include <ranges>

#include "interfaces/robot/mass.hpp"

namespace sim::blind {
namespace {

/// Returns the factor for the next constant.
using Factor = std::function<double()>;

/// Multiplies constants and lists them.
class Draw {
 public:
  Draw(Factor factor, std::vector<Drawn>& drawn) : factor_(std::move(factor)), drawn_(drawn) {}

  double factor() { return factor_(); }
  void multiply_constant(const std::string& on, const char* name, double& value) {
    if (value == 0) return;
    value *= factor();
    add(on, name, value);
  }
  void add(const std::string& on, const char* name, double value) {
    drawn_.push_back({on, name, value});
  }

 private:
  Factor factor_;
  std::vector<Drawn>& drawn_;
};

void multiply(erp::MotorType& m, const std::string& on, Draw& draw) {
  draw.multiply_constant(on, "resistance_ohm", m.resistance_ohm);
  draw.multiply_constant(on, "inductance_H", m.inductance_H);
  const double magnet = draw.factor();
  m.back_emf_V_s_per_rad *= magnet, m.torque_Nm_per_A *= magnet;
  draw.add(on, "back_emf_V_s_per_rad", m.back_emf_V_s_per_rad);
  draw.add(on, "torque_Nm_per_A", m.torque_Nm_per_A);
  draw.multiply_constant(on, "gear_efficiency", m.gear_efficiency);
  m.gear_efficiency = std::min(m.gear_efficiency, 1.0);
  draw.multiply_constant(on, "rotor_inertia_kg_m2", m.rotor_inertia_kg_m2);
  draw.multiply_constant(on, "rotor_viscous_Nm_s_per_rad", m.rotor_viscous_Nm_s_per_rad);
  draw.multiply_constant(on, "gear_viscous_Nm_s_per_rad", m.gear_viscous_Nm_s_per_rad);
  draw.multiply_constant(on, "rotor_coulomb_Nm", m.rotor_coulomb_Nm);
  draw.multiply_constant(on, "gear_coulomb_Nm", m.gear_coulomb_Nm);
}

void multiply(erp::Body& body, Draw& draw) {
  const erp::Mass nominal = erp::mass_of(body);
  if (!(nominal.mass_kg > 0)) return;
  const double mass = draw.factor(), com = draw.factor(), inertia = draw.factor();
  const auto& i = nominal.inertia_kg_m2;
  body.mass_kg = mass * nominal.mass_kg;
  body.com_m = {com * nominal.com_m[0], com * nominal.com_m[1], com * nominal.com_m[2]};
  const double moments = mass * inertia;
  body.inertia_kg_m2 = {moments * i[0], moments * i[1], moments * i[2]};
  body.products_kg_m2 = {moments * i[3], moments * i[4], moments * i[5]};
  body.density_kg_per_m3.reset();
  std::erase_if(body.parts,
                [](const erp::Part& part) { return std::holds_alternative<erp::Weight>(part); });
  draw.add(body.name, "mass", mass), draw.add(body.name, "com", com);
  draw.add(body.name, "inertia", inertia);
}

AsBuilt multiplied(const erp::Robot& nominal, Factor factor, HiddenEffects& hidden_effects) {
  AsBuilt built{nominal, {}};
  Draw draw(std::move(factor), built.drawn);
  for (std::size_t a = 0; a < built.robot.actuators.size(); ++a) {
    erp::Actuator& actuator = built.robot.actuators[a];
    erp::MotorType motor = built.robot.motor_of(actuator);
    motor.name = actuator.name + "_motor";
    multiply(motor, actuator.name, draw);
    built.robot.motor_types.push_back(motor);
    actuator.motor = motor.name;
    draw.multiply_constant(actuator.name, "radius_m", actuator.spindle.radius_m);
    draw.multiply_constant(actuator.name, "stiffness_N_per_m", actuator.tendon.stiffness_N_per_m);
    draw.multiply_constant(actuator.name, "damping_N_s_per_m", actuator.tendon.damping_N_s_per_m);
    const double arm = draw.factor();
    hidden_effects.channels[a].moment_arm += arm - 1;
    draw.add(actuator.name, "moment_arm", arm);
  }
  for (erp::Skeleton& part : built.robot.skeletons) {
    for (erp::Joint& joint : part.joints) {
      draw.multiply_constant(joint.name, "viscous_Nm_s_per_rad", joint.viscous_Nm_s_per_rad);
      draw.multiply_constant(joint.name, "coulomb_Nm", joint.coulomb_Nm);
    }
    for (erp::Body& body : part.bodies) multiply(body, draw);
  }
  return built;
}

}  // namespace

AsBuilt as_built(const erp::Robot& nominal, double relative, std::uint64_t seed,
                 HiddenEffects& hidden_effects) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> deviation(0, relative);
  return multiplied(
      nominal, [&] { return 1 + deviation(random); }, hidden_effects);
}

AsBuilt many_off(const erp::Robot& nominal, std::uint64_t seed, HiddenEffects& hidden_effects) {
  std::vector<double> factors;
  HiddenEffects unused = hidden_effects;
  multiplied(
      nominal, [&] { return factors.emplace_back(1); }, unused);
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::size_t> count(8, 12);
  std::uniform_real_distribution<double> relative_error(0.02, 0.10);
  std::bernoulli_distribution is_negative;
  std::vector<std::size_t> order(factors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::shuffle(order, random);
  for (const std::size_t k : order | std::views::take(count(random)))
    factors[k] += (is_negative(random) ? -1 : 1) * relative_error(random);
  return multiplied(
      nominal, [next = factors.begin()]() mutable { return *next++; }, hidden_effects);
}

}  // namespace sim::blind
