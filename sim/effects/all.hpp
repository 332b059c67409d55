#pragma once
// Every effect the simulator can add and the diagnosis may name: one include and one line each.
#include <variant>

#include "sim/effects/bus/command_delay.hpp"
#include "sim/effects/bus/frame_loss.hpp"
#include "sim/effects/bus/jitter.hpp"
#include "sim/effects/bus/sensor_delay.hpp"
#include "sim/effects/gearbox/ageing_stiction.hpp"
#include "sim/effects/gearbox/asymmetric.hpp"
#include "sim/effects/gearbox/backlash.hpp"
#include "sim/effects/gearbox/coulomb.hpp"
#include "sim/effects/gearbox/efficiency.hpp"
#include "sim/effects/gearbox/inertia.hpp"
#include "sim/effects/gearbox/load_dependent.hpp"
#include "sim/effects/gearbox/position_dependent.hpp"
#include "sim/effects/gearbox/shaft_compliance.hpp"
#include "sim/effects/gearbox/stribeck.hpp"
#include "sim/effects/gearbox/viscous.hpp"
#include "sim/effects/joint/coulomb.hpp"
#include "sim/effects/joint/early_stop.hpp"
#include "sim/effects/joint/passive_stiffness.hpp"
#include "sim/effects/joint/play.hpp"
#include "sim/effects/joint/stribeck.hpp"
#include "sim/effects/joint/viscous.hpp"
#include "sim/effects/motor/cogging.hpp"
#include "sim/effects/motor/dead_band.hpp"
#include "sim/effects/motor/driver_delay.hpp"
#include "sim/effects/motor/inductance.hpp"
#include "sim/effects/motor/resistance.hpp"
#include "sim/effects/motor/supply_sag.hpp"
#include "sim/effects/motor/thermal_resistance.hpp"
#include "sim/effects/motor/torque_constant.hpp"
#include "sim/effects/routing/attachment_shift.hpp"
#include "sim/effects/routing/capstan.hpp"
#include "sim/effects/routing/moment_arm.hpp"
#include "sim/effects/routing/pulley_radius.hpp"
#include "sim/effects/sensor/drift.hpp"
#include "sim/effects/sensor/eccentricity.hpp"
#include "sim/effects/sensor/gain.hpp"
#include "sim/effects/sensor/low_pass.hpp"
#include "sim/effects/sensor/offset.hpp"
#include "sim/effects/sensor/quantisation.hpp"
#include "sim/effects/skeleton/base_tilt.hpp"
#include "sim/effects/skeleton/com.hpp"
#include "sim/effects/skeleton/inertia.hpp"
#include "sim/effects/skeleton/link_flexibility.hpp"
#include "sim/effects/skeleton/mass.hpp"
#include "sim/effects/skeleton/payload.hpp"
#include "sim/effects/spindle/layers.hpp"
#include "sim/effects/spindle/radius.hpp"
#include "sim/effects/spindle/slip.hpp"
#include "sim/effects/tendon/creep.hpp"
#include "sim/effects/tendon/damping.hpp"
#include "sim/effects/tendon/hysteresis.hpp"
#include "sim/effects/tendon/kite_line.hpp"
#include "sim/effects/tendon/length_offset.hpp"
#include "sim/effects/tendon/stiffening.hpp"
#include "sim/effects/tendon/stiffness.hpp"

namespace sim::effects {

// clang-format off
/// In the order of the chain, and in this order they act.
using AnyEffect = std::variant<
    CommandDelay, SensorDelay, Jitter, FrameLoss,
    MotorResistance, MotorTorqueConstant, MotorInductance, MotorThermalResistance, MotorCogging,
    MotorDriverDelay, MotorDeadBand, SupplySag,
    GearboxCoulomb, GearboxAsymmetric, GearboxViscous, GearboxStribeck, GearboxAgeingStiction,
    GearboxLoadDependent, GearboxPositionDependent, GearboxEfficiency,
    GearboxBacklash, GearboxInertia, GearboxShaftCompliance,
    SpindleRadius, SpindleLayers, SpindleSlip,
    TendonStiffness, TendonStiffening, TendonDamping, TendonCreep, TendonHysteresis,
    TendonLengthOffset, TendonKiteLine,
    RoutingCapstan, RoutingAttachmentShift, RoutingPulleyRadius, RoutingMomentArm,
    JointCoulomb, JointViscous, JointStribeck, JointPassiveStiffness, JointEarlyStop, JointPlay,
    SkeletonMass, SkeletonCom, SkeletonInertia, SkeletonPayload, BaseTilt, LinkFlexibility,
    SensorOffset<Sense::shaft>, SensorOffset<Sense::current>, SensorOffset<Sense::tension>,
    SensorOffset<Sense::joint>,
    SensorGain<Sense::shaft>, SensorGain<Sense::current>, SensorGain<Sense::tension>,
    SensorGain<Sense::joint>,
    SensorDrift<Sense::shaft>, SensorDrift<Sense::current>, SensorDrift<Sense::tension>,
    SensorDrift<Sense::joint>,
    SensorLowPass<Sense::shaft>, SensorLowPass<Sense::current>, SensorLowPass<Sense::tension>,
    SensorLowPass<Sense::joint>,
    SensorEccentricity<Sense::shaft>, SensorEccentricity<Sense::joint>,
    SensorQuantisation<Sense::shaft>, SensorQuantisation<Sense::current>,
    SensorQuantisation<Sense::tension>, SensorQuantisation<Sense::joint>>;
// clang-format on

}  // namespace sim::effects
