// Checks that need a modified robot; tests/interfaces/broken/robot contains one file per error.
#include "interfaces/robot/check.hpp"

#include <catch2/catch.hpp>

namespace {

erp::Robot checked_rig() { return erp::read_robot(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml"); }

std::string errors_of(const erp::Robot& robot) {
  std::string text;
  for (const auto& error : erp::check_robot(robot)) text += to_string(error) + "\n";
  return text;
}

}  // namespace

TEST_CASE("a valid robot gives no errors") { CHECK(errors_of(checked_rig()).empty()); }

TEST_CASE("64 actuators are accepted and 65 are rejected") {
  erp::Robot robot = checked_rig();
  const erp::Actuator flexor = robot.actuators[0];
  robot.actuators.clear();
  robot.can_buses.clear();
  for (int i = 0; i < 64; ++i) {
    robot.actuators.push_back(flexor);
    robot.actuators.back().name = "a" + std::to_string(i);
    robot.actuators.back().ecu = i;
  }
  CHECK(errors_of(robot).empty());
  robot.actuators.push_back(flexor);
  robot.actuators.back().ecu = 64;
  CHECK_THAT(errors_of(robot), Catch::Contains("65 actuators; the bus allows at most 64"));
}

TEST_CASE("a loop of joints is reported once, without the joints that are attached to it") {
  erp::Robot robot = checked_rig();
  auto& skeleton = robot.skeletons[0];
  for (const char* name : {"a", "b", "c", "d"}) {
    skeleton.bodies.push_back({{}, name, 1.0});
    skeleton.joints.push_back({{}, std::string("to_") + name, erp::JointType::fixed, "", name});
  }
  const auto parent_of = [&](std::size_t joint) -> std::string& {
    return skeleton.joints.at(joint).parent;
  };
  parent_of(1) = "c", parent_of(2) = "a", parent_of(3) = "b", parent_of(4) = "c";
  const std::string errors = errors_of(robot);
  CHECK_THAT(errors, Catch::Contains("the joints form a loop: a < c < b < a"));
  CHECK(errors.find("loop") == errors.rfind("loop"));
}

TEST_CASE("a joint whose parent is its own child is a loop") {
  erp::Robot robot = checked_rig();
  robot.skeletons[0].joints[0].parent = "forearm";
  CHECK_THAT(errors_of(robot), Catch::Contains("loop: forearm < forearm"));
}

TEST_CASE("spherical and fixed joints need no axis and no limits") {
  erp::Robot robot = checked_rig();
  robot.joint_sensors.clear();
  auto& joint = robot.skeletons[0].joints[0];
  joint.axis = {0, 0, 0};
  joint.min_rad = 3;
  joint.type = erp::JointType::spherical;
  CHECK(errors_of(robot).empty());
}

TEST_CASE("two sensors on one input or on one joint are rejected") {
  erp::Robot robot = checked_rig();
  robot.joint_sensors.push_back(robot.joint_sensors[0]);
  CHECK_THAT(errors_of(robot), Catch::Contains("input=\"0\" already reads joint \"elbow\"") &&
                                   Catch::Contains("a second sensor on joint \"elbow\""));
}

TEST_CASE(
    "a point inside its neighbouring pulley is rejected; a point on its surface is accepted") {
  erp::Robot robot = checked_rig();
  auto& path = robot.actuators[0].tendon.path;
  std::get<erp::Attach>(path[1]).at_m = {-0.025, 0, 0};
  std::get<erp::Attach>(path[0]).at_m = {0, 0, 0.001};
  CHECK(errors_of(robot).empty());
  std::get<erp::Attach>(path[1]).at_m = {-0.0249, 0, 0};
  CHECK_THAT(errors_of(robot), Catch::Contains("inside its radius_m=\"0.025\""));
}

TEST_CASE("relax_tension_N and pretension_N above max_tension_N are rejected") {
  erp::Robot robot = checked_rig();
  robot.actuators[0].relax_tension_N = 151;
  robot.actuators[1].tendon.pretension_N = 151;
  CHECK_THAT(errors_of(robot),
             Catch::Contains("relax_tension_N=\"151\" exceeds max_tension_N=\"150\"") &&
                 Catch::Contains("pretension_N=\"151\" exceeds max_tension_N=\"150\""));
}
