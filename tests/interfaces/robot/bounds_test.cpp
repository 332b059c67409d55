// The bounds that robot.xml is checked against are the messages' bounds.
#include <catch2/catch.hpp>

#include "interfaces/robot/check.hpp"
#include "interfaces/topics.hpp"

TEST_CASE("the longest name and the largest robot fit the messages exactly") {
  namespace bound = erp::robot_check;
  erp::SensorFrame frame;
  erp::BodyPose poses;
  CHECK(sizeof frame.robot == bound::longest_name + 1);
  CHECK(sizeof erp::ActuatorSample::name == bound::longest_name + 1);
  CHECK(sizeof erp::JointSample::name == bound::longest_name + 1);
  CHECK(sizeof erp::BodyPoseSample::name == bound::longest_name + 1);
  CHECK(sizeof erp::ComponentState{}.component == 33);
  CHECK(frame.actuators._maximum == bound::most_actuators);
  CHECK(frame.joints._maximum == bound::most_joints);
  CHECK(poses.bodies._maximum == bound::most_bodies);
  CHECK(erp::ImuFrame{}.imus._maximum == bound::most_imus);
}
