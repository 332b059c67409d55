#include "interfaces/robot/robot.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/interfaces/xml/xmllint.hpp"

namespace {

const std::string hinge_rig = ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml";

erp::Robot from_text(const std::string& text) {
  const std::string file = temporary("robot.xml", text);
  erp::Robot robot = erp::read_robot(file);
  std::filesystem::remove(file);
  return robot;
}

}  // namespace

TEST_CASE("a robot written to one file is read back bit-equal") {
  erp::Robot robot = erp::read_robot(hinge_rig);
  robot.motor_types[0].resistance_ohm = 0.1 + 0.2;
  robot.skeletons[0].joints[0].at_m = {1.0 / 3, -2e-17, 4e9};
  const std::string text = erp::write_robot(robot);
  const erp::Robot read_back = from_text(text);
  CHECK(erp::write_robot(read_back) == text);
  CHECK(read_back.motor_types[0].resistance_ohm == 0.1 + 0.2);
  CHECK(read_back.joints()[0].at_m == robot.joints()[0].at_m);
  CHECK(read_back.actuators[1].tendon.path.size() == robot.actuators[1].tendon.path.size());
}

TEST_CASE("a robot combines bodies, joints and gravity of all its skeletons") {
  const auto robot = from_text(R"(<robot name="r">
    <skeleton><body name="a"/><body name="b" mass_kg="1"/>
      <joint name="j" type="fixed" parent="a" child="b"/></skeleton>
    <skeleton gravity_m_per_s2="0 0 -3.7"><body name="c" mass_kg="1"/>
      <joint name="k" type="spherical" parent="b" child="c"/></skeleton></robot>)");
  CHECK(robot.bodies().size() == 3);
  CHECK(robot.joints().at(1).type == erp::JointType::spherical);
  CHECK(robot.gravity_m_per_s2() == erp::Vec3{0, 0, -3.7});
}

TEST_CASE("a robot without gravity_m_per_s2 has zero gravity") {
  CHECK(from_text("<robot name='r'/>").gravity_m_per_s2() == erp::Vec3{0, 0, 0});
}

TEST_CASE("an actuator's motor and sensors are found by name") {
  const erp::Robot robot = erp::read_robot(hinge_rig);
  CHECK(robot.motor_of(robot.actuators[0]).gear_ratio == 128);
  CHECK(robot.sensors_of(robot.actuators[0]).tension_range_N == 200);
  erp::Actuator other;
  other.motor = "none";
  CHECK_THROWS_AS(robot.motor_of(other), std::out_of_range);
}
