#include "sim/blind/tolerance.hpp"

#include <algorithm>
#include <random>

#include "interfaces/robot/mass.hpp"

namespace sim::blind {
namespace {

class Draw {
 public:
  Draw(double relative, std::uint64_t seed, std::vector<Drawn>& drawn)
      : random_(seed), by_(0, relative), drawn_(drawn) {}

  double factor() { return 1 + by_(random_); }
  void number(const std::string& on, const char* name, double& value) {
    if (value == 0) return;
    value *= factor();
    tell(on, name, value);
  }
  void tell(const std::string& on, const char* name, double value) {
    drawn_.push_back({on, name, value});
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> by_;
  std::vector<Drawn>& drawn_;
};

void off(erp::MotorType& m, const std::string& on, Draw& draw) {
  draw.number(on, "resistance_ohm", m.resistance_ohm);
  draw.number(on, "inductance_H", m.inductance_H);
  const double magnet = draw.factor();
  m.back_emf_V_s_per_rad *= magnet, m.torque_Nm_per_A *= magnet;
  draw.tell(on, "back_emf_V_s_per_rad", m.back_emf_V_s_per_rad);
  draw.tell(on, "torque_Nm_per_A", m.torque_Nm_per_A);
  draw.number(on, "gear_efficiency", m.gear_efficiency);
  m.gear_efficiency = std::min(m.gear_efficiency, 1.0);
  draw.number(on, "rotor_inertia_kg_m2", m.rotor_inertia_kg_m2);
  draw.number(on, "rotor_viscous_Nm_s_per_rad", m.rotor_viscous_Nm_s_per_rad);
  draw.number(on, "gear_viscous_Nm_s_per_rad", m.gear_viscous_Nm_s_per_rad);
  draw.number(on, "rotor_coulomb_Nm", m.rotor_coulomb_Nm);
  draw.number(on, "gear_coulomb_Nm", m.gear_coulomb_Nm);
}

void off(erp::Body& body, Draw& draw) {
  const erp::Mass was = erp::mass_of(body);
  if (!(was.mass_kg > 0)) return;
  const double mass = draw.factor(), com = draw.factor(), inertia = draw.factor();
  const auto& i = was.inertia_kg_m2;
  body.mass_kg = mass * was.mass_kg;
  body.com_m = {com * was.com_m[0], com * was.com_m[1], com * was.com_m[2]};
  body.inertia_kg_m2 = {inertia * i[0], inertia * i[1], inertia * i[2]};
  body.products_kg_m2 = {inertia * i[3], inertia * i[4], inertia * i[5]};
  body.density_kg_per_m3.reset();
  std::erase_if(body.parts,
                [](const erp::Part& part) { return std::holds_alternative<erp::Weight>(part); });
  draw.tell(body.name, "mass", mass), draw.tell(body.name, "com", com);
  draw.tell(body.name, "inertia", inertia);
}

}  // namespace

AsBuilt as_built(const erp::Robot& nominal, double relative, std::uint64_t seed, Quirks& quirks) {
  AsBuilt built{nominal, {}};
  Draw draw(relative, seed, built.drawn);
  for (std::size_t a = 0; a < built.robot.actuators.size(); ++a) {
    erp::Actuator& actuator = built.robot.actuators[a];
    erp::MotorType motor = built.robot.motor_of(actuator);
    motor.name = actuator.name + "_motor";
    off(motor, actuator.name, draw);
    built.robot.motor_types.push_back(motor);
    actuator.motor = motor.name;
    draw.number(actuator.name, "radius_m", actuator.spindle.radius_m);
    draw.number(actuator.name, "stiffness_N_per_m", actuator.tendon.stiffness_N_per_m);
    draw.number(actuator.name, "damping_N_s_per_m", actuator.tendon.damping_N_s_per_m);
    const double arm = draw.factor();
    quirks.chains[a].arm += arm - 1;
    draw.tell(actuator.name, "moment_arm", arm);
  }
  for (erp::Skeleton& part : built.robot.skeletons) {
    for (erp::Joint& joint : part.joints) {
      draw.number(joint.name, "viscous_Nm_s_per_rad", joint.viscous_Nm_s_per_rad);
      draw.number(joint.name, "coulomb_Nm", joint.coulomb_Nm);
    }
    for (erp::Body& body : part.bodies) off(body, draw);
  }
  return built;
}

}  // namespace sim::blind
