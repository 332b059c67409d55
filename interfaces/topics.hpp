#pragma once
// All topics: every message, its C++ name, its topic name. One line per message.
#include <tuple>

#include "interfaces/idl/actuator_command.h"
#include "interfaces/idl/actuator_owner.h"
#include "interfaces/idl/actuator_target.h"
#include "interfaces/idl/body_pose.h"
#include "interfaces/idl/clock.h"
#include "interfaces/idl/component_state.h"
#include "interfaces/idl/ecu_command.h"
#include "interfaces/idl/ecu_frame.h"
#include "interfaces/idl/ecu_parameter.h"
#include "interfaces/idl/event.h"
#include "interfaces/idl/gain_command.h"
#include "interfaces/idl/image_point.h"
#include "interfaces/idl/imu_frame.h"
#include "interfaces/idl/joint_state.h"
#include "interfaces/idl/joint_target.h"
#include "interfaces/idl/lifecycle_command.h"
#include "interfaces/idl/sensor_frame.h"
#include "interfaces/idl/stage_residual.h"
#include "interfaces/message.hpp"

namespace erp {

using ActuatorReference = erp_ActuatorReference;
using ActuatorSample = erp_ActuatorSample;
using JointSample = erp_JointSample;
using EcuChannelCommand = erp_EcuChannelCommand;
using EcuChannelSample = erp_EcuChannelSample;
using EcuAnalogSample = erp_EcuAnalogSample;
using EcuParameterValue = erp_EcuParameterValue;
using GainValue = erp_GainValue;
using JointStateSample = erp_JointStateSample;
using JointTargetSample = erp_JointTargetSample;
using BodyPoseSample = erp_BodyPoseSample;
using ActuatorOwnerSample = erp_ActuatorOwnerSample;
using ImagePointSample = erp_ImagePointSample;
using ImuSample = erp_ImuSample;
using StageSample = erp_StageSample;
using ComponentValue = erp_ComponentValue;

template <>
inline constexpr std::size_t capacity_of<JointSample> = 128;
template <>
inline constexpr std::size_t capacity_of<EcuAnalogSample> = 128;
template <>
inline constexpr std::size_t capacity_of<JointStateSample> = 128;
template <>
inline constexpr std::size_t capacity_of<JointTargetSample> = 128;
template <>
inline constexpr std::size_t capacity_of<BodyPoseSample> = 128;
template <>
inline constexpr std::size_t capacity_of<ImagePointSample> = 256;
template <>
inline constexpr std::size_t capacity_of<ImuSample> = 32;
template <>
inline constexpr std::size_t capacity_of<StageSample> = 320;
template <>
inline constexpr std::size_t capacity_of<ComponentValue> = 128;
template <>
inline constexpr std::size_t capacity_of<EcuParameterValue> = 2560;
template <>
inline constexpr std::size_t capacity_of<GainValue> = 2048;

using ActuatorCommand = Message<erp_ActuatorCommand, &erp_ActuatorCommand::actuators>;
using ActuatorTarget = Message<erp_ActuatorTarget, &erp_ActuatorTarget::actuators>;
using SensorFrame = Message<erp_SensorFrame, &erp_SensorFrame::actuators, &erp_SensorFrame::joints>;
using EcuCommand = Message<erp_EcuCommand, &erp_EcuCommand::channels>;
using EcuFrame = Message<erp_EcuFrame, &erp_EcuFrame::channels, &erp_EcuFrame::analogs>;
using EcuParameter = Message<erp_EcuParameter, &erp_EcuParameter::values>;
using GainCommand = Message<erp_GainCommand, &erp_GainCommand::gains>;
using JointState = Message<erp_JointState, &erp_JointState::joints>;
using JointTarget = Message<erp_JointTarget, &erp_JointTarget::joints>;
using BodyPose = Message<erp_BodyPose, &erp_BodyPose::bodies>;
using ImagePoint = Message<erp_ImagePoint, &erp_ImagePoint::points>;
using ImuFrame = Message<erp_ImuFrame, &erp_ImuFrame::imus>;
using StageResidual = Message<erp_StageResidual, &erp_StageResidual::stages>;
using ActuatorOwner = Message<erp_ActuatorOwner, &erp_ActuatorOwner::actuators>;
using ComponentState = Message<erp_ComponentState, &erp_ComponentState::values>;
using LifecycleCommand = Message<erp_LifecycleCommand>;
using Clock = Message<erp_Clock>;
using Event = Message<erp_Event>;

/// Messages that a reader keeps until it takes them. The only key of a topic is the robot, so this
/// bounds the memory of a reader, whatever the names of the senders. Chosen.
namespace depth {
inline constexpr int one_sender = 1;         ///< the newest message
inline constexpr int several_senders = 64;   ///< some messages of each controller or source
inline constexpr int all_components = 512;   ///< a burst from every component of a graph
}  // namespace depth

/// A message's topic: `name` on the bus, `type` its descriptor, `depth` of its readers' queues.
template <class M>
struct Topic;
#define ERP_TOPIC(M, topic, senders)               \
  template <>                                      \
  struct Topic<M> {                                \
    static constexpr const char* name = topic;     \
    static constexpr auto* type = &erp_##M##_desc; \
    static constexpr int depth = depth::senders;   \
  };
ERP_TOPIC(ActuatorCommand, "actuator_command", several_senders)   // controllers -> plant
ERP_TOPIC(ActuatorTarget, "actuator_target", several_senders)     // reference -> controllers
ERP_TOPIC(SensorFrame, "sensor_frame", one_sender)                // plant -> all
ERP_TOPIC(EcuCommand, "ecu_command", one_sender)                  // plant -> device
ERP_TOPIC(EcuFrame, "ecu_frame", one_sender)                      // device -> plant
ERP_TOPIC(EcuParameter, "ecu_parameter", one_sender)              // plant -> device
ERP_TOPIC(GainCommand, "gain_command", several_senders)           // controllers -> plant
ERP_TOPIC(JointState, "joint_state", several_senders)             // sim (truth), pose_estimator, motion_capture
ERP_TOPIC(JointTarget, "joint_target", several_senders)           // joint_target, planners -> controllers
ERP_TOPIC(BodyPose, "body_pose", several_senders)                 // sim, motion_capture
ERP_TOPIC(ImagePoint, "image_point", several_senders)             // eye -> controllers
ERP_TOPIC(ImuFrame, "imu_frame", several_senders)                 // sim, or a driver
ERP_TOPIC(StageResidual, "stage_residual", one_sender)            // gap_monitor -> all
ERP_TOPIC(ActuatorOwner, "actuator_owner", one_sender)            // plant -> all
ERP_TOPIC(ComponentState, "component_state", all_components)      // every component
ERP_TOPIC(LifecycleCommand, "lifecycle_command", all_components)  // launcher -> one component
ERP_TOPIC(Clock, "clock", one_sender)                             // sim -> all
ERP_TOPIC(Event, "event", all_components)                         // all
#undef ERP_TOPIC

/// All message types, for code that handles every topic.
using Messages =
    std::tuple<ActuatorCommand, ActuatorTarget, SensorFrame, EcuCommand, EcuFrame, EcuParameter,
               GainCommand, JointState, JointTarget, BodyPose, ImagePoint, ImuFrame, StageResidual,
               ActuatorOwner, ComponentState, LifecycleCommand, Clock, Event>;

}  // namespace erp
