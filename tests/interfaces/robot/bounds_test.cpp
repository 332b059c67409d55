// Compares the bounds in check.hpp with the bounds of the messages.
#include <catch2/catch.hpp>

#include "interfaces/robot/check.hpp"
#include "interfaces/topics.hpp"

TEST_CASE("maximum name length and element counts of robot.xml equal the bounds of the messages") {
  namespace bound = erp::robot_check;
  erp::SensorFrame frame;
  erp::BodyPose poses;
  CHECK(sizeof frame.robot == bound::max_name_length + 1);
  CHECK(sizeof erp::ActuatorSample::name == bound::max_name_length + 1);
  CHECK(sizeof erp::JointSample::name == bound::max_name_length + 1);
  CHECK(sizeof erp::BodyPoseSample::name == bound::max_name_length + 1);
  CHECK(sizeof erp::ComponentState{}.component == 33);
  CHECK(frame.actuators._maximum == bound::max_actuators);
  CHECK(frame.joints._maximum == bound::max_joints);
  CHECK(poses.bodies._maximum == bound::max_bodies);
  CHECK(erp::ImuFrame{}.imus._maximum == bound::max_imus);
}
