// Values of the hinge rig to which other tests and publications refer.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "interfaces/robot/robot.hpp"

namespace {

erp::Robot rig() { return erp::read_robot(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml"); }

/// The pulley and its two neighbouring points; `end` moves with the elbow.
struct AroundPulley {
  erp::Attach guide;
  erp::Pulley pulley;
  erp::Attach end;
};
AroundPulley around_pulley(const erp::Actuator& actuator) {
  const auto& path = actuator.tendon.path;
  return {std::get<erp::Attach>(path.at(1)), std::get<erp::Pulley>(path.at(2)),
          std::get<erp::Attach>(path.at(3))};
}

/// Angle of a point in the xz plane about the elbow's axis +y, from z towards x.
double angle_rad(const erp::Vec3& p) { return std::atan2(p[0], p[2]); }
double radius_m(const erp::Vec3& p) { return std::hypot(p[0], p[2]); }

/// Angle from guide to end along the tendon: via −x for the flexor, via +x for the extensor.
double path_angle_rad(const AroundPulley& a, double elbow_rad) {
  const double angle_from_guide_rad = angle_rad(a.end.at_m) + elbow_rad - angle_rad(a.guide.at_m);
  const double along_path = a.guide.at_m[0] < 0 ? -angle_from_guide_rad : angle_from_guide_rad;
  return std::fmod(along_path + 4 * std::numbers::pi, 2 * std::numbers::pi);
}

// L = √(a²−r²) + √(b²−r²) + r (θ − α − β), α = acos(r/a), β = acos(r/b); a, b: distances of guide
// and end
double length_m(const AroundPulley& a, double elbow_rad) {
  const double r = a.pulley.radius_m, guide_distance_m = radius_m(a.guide.at_m),
               end_distance_m = radius_m(a.end.at_m);
  const double wrap_angle_rad = path_angle_rad(a, elbow_rad) - std::acos(r / guide_distance_m) -
                                std::acos(r / end_distance_m);
  REQUIRE(wrap_angle_rad > 0.05);
  return std::sqrt(guide_distance_m * guide_distance_m - r * r) +
         std::sqrt(end_distance_m * end_distance_m - r * r) + r * wrap_angle_rad;
}

}  // namespace

TEST_CASE("the forearm's inertia about the elbow is 0.01752 kg m2") {
  const auto robot = rig();
  const erp::Body forearm = robot.bodies().at(1);
  CHECK(forearm.com_m == erp::Vec3{0, 0, -0.12});
  // Steiner: I = I_c + m d²
  CHECK(forearm.inertia_kg_m2[1] + forearm.mass_kg * 0.12 * 0.12 == Approx(0.01752).epsilon(1e-12));
}

TEST_CASE("the elbow's axis is +y and its limits are -1.2 and 1.6 rad") {
  const erp::Joint elbow = rig().joints().at(0);
  CHECK(elbow.axis == erp::Vec3{0, 1, 0});
  CHECK(elbow.at_m == erp::Vec3{0, 0, 0});
  CHECK(elbow.min_rad == -1.2);
  CHECK(elbow.max_rad == 1.6);
}

TEST_CASE(
    "over the whole range flexion shortens the flexor by 25 mm/rad and lengthens the extensor") {
  const auto robot = rig();
  const auto flexor = around_pulley(robot.actuators.at(0));
  const auto extensor = around_pulley(robot.actuators.at(1));
  const double h = 1e-4;
  for (double q = -1.2; q <= 1.6; q += 0.05) {
    INFO("elbow at " << q);
    CHECK((length_m(flexor, q + h) - length_m(flexor, q - h)) / (2 * h) == Approx(-0.025));
    CHECK((length_m(extensor, q + h) - length_m(extensor, q - h)) / (2 * h) == Approx(0.025));
  }
}

TEST_CASE("over the whole range the tendons wrap around their pulley by less than half a turn") {
  const auto robot = rig();
  for (const auto& actuator : robot.actuators)
    for (double q : {-1.2, 1.6}) CHECK(path_angle_rad(around_pulley(actuator), q) < 3.05);
}

TEST_CASE("the motor's derived constants equal the published ones") {
  const erp::MotorType m = rig().motor_types.at(0);
  // J_tot = (J_M + J_G) N² η: the rotor's inertia referred to the output
  const double inertia = (m.rotor_inertia_kg_m2 + m.gear_inertia_kg_m2) * std::pow(m.gear_ratio, 2);
  CHECK(inertia * m.gear_efficiency == Approx(0.01402).epsilon(0.03));
  // current that holds 40 N: i = 40 N · r / (K_T N η) = 0.207 A
  CHECK(40 * 0.0045 / (m.torque_Nm_per_A * m.gear_ratio * m.gear_efficiency) ==
        Approx(0.207).epsilon(0.005));
  CHECK(m.supply_V / (m.back_emf_V_s_per_rad * m.gear_ratio) == Approx(8.15).epsilon(0.001));
}

TEST_CASE("every element of the rig that contains numbers has a source") {
  const auto robot = rig();
  for (const auto& body : robot.bodies()) CHECK_FALSE(body.source.empty());
  for (const auto& joint : robot.joints()) CHECK_FALSE(joint.source.empty());
  for (const auto& type : robot.motor_types) CHECK_FALSE(type.source.empty());
  for (const auto& type : robot.sensor_types) CHECK_FALSE(type.source.empty());
  for (const auto& sensor : robot.joint_sensors) CHECK_FALSE(sensor.source.empty());
  for (const auto& actuator : robot.actuators) {
    CHECK_FALSE(actuator.source.empty());
    CHECK_FALSE(actuator.tendon.source.empty());
  }
}
