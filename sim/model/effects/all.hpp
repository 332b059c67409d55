#pragma once
// All effects that the simulator can apply and the diagnosis can identify: one include and one line
// per effect.
#include <variant>

#include "sim/model/effects/bus/command_delay.hpp"
#include "sim/model/effects/bus/frame_loss.hpp"
#include "sim/model/effects/bus/jitter.hpp"
#include "sim/model/effects/bus/sensor_delay.hpp"
#include "sim/model/effects/gearbox/ageing_stiction.hpp"
#include "sim/model/effects/gearbox/asymmetric.hpp"
#include "sim/model/effects/gearbox/backlash.hpp"
#include "sim/model/effects/gearbox/coulomb.hpp"
#include "sim/model/effects/gearbox/efficiency.hpp"
#include "sim/model/effects/gearbox/inertia.hpp"
#include "sim/model/effects/gearbox/load_dependent.hpp"
#include "sim/model/effects/gearbox/position_dependent.hpp"
#include "sim/model/effects/gearbox/shaft_compliance.hpp"
#include "sim/model/effects/gearbox/stribeck.hpp"
#include "sim/model/effects/gearbox/viscous.hpp"
#include "sim/model/effects/joint/coulomb.hpp"
#include "sim/model/effects/joint/early_stop.hpp"
#include "sim/model/effects/joint/passive_stiffness.hpp"
#include "sim/model/effects/joint/play.hpp"
#include "sim/model/effects/joint/stribeck.hpp"
#include "sim/model/effects/joint/viscous.hpp"
#include "sim/model/effects/motor/cogging.hpp"
#include "sim/model/effects/motor/dead_band.hpp"
#include "sim/model/effects/motor/driver_delay.hpp"
#include "sim/model/effects/motor/inductance.hpp"
#include "sim/model/effects/motor/resistance.hpp"
#include "sim/model/effects/motor/supply_sag.hpp"
#include "sim/model/effects/motor/thermal_resistance.hpp"
#include "sim/model/effects/motor/torque_constant.hpp"
#include "sim/model/effects/routing/attachment_shift.hpp"
#include "sim/model/effects/routing/capstan.hpp"
#include "sim/model/effects/routing/moment_arm.hpp"
#include "sim/model/effects/routing/pulley_radius.hpp"
#include "sim/model/effects/sensor/drift.hpp"
#include "sim/model/effects/sensor/eccentricity.hpp"
#include "sim/model/effects/sensor/gain.hpp"
#include "sim/model/effects/sensor/low_pass.hpp"
#include "sim/model/effects/sensor/offset.hpp"
#include "sim/model/effects/sensor/quantisation.hpp"
#include "sim/model/effects/skeleton/base_tilt.hpp"
#include "sim/model/effects/skeleton/com.hpp"
#include "sim/model/effects/skeleton/inertia.hpp"
#include "sim/model/effects/skeleton/link_flexibility.hpp"
#include "sim/model/effects/skeleton/mass.hpp"
#include "sim/model/effects/skeleton/payload.hpp"
#include "sim/model/effects/spindle/layers.hpp"
#include "sim/model/effects/spindle/radius.hpp"
#include "sim/model/effects/spindle/slip.hpp"
#include "sim/model/effects/tendon/creep.hpp"
#include "sim/model/effects/tendon/damping.hpp"
#include "sim/model/effects/tendon/hysteresis.hpp"
#include "sim/model/effects/tendon/kite_line.hpp"
#include "sim/model/effects/tendon/length_offset.hpp"
#include "sim/model/effects/tendon/stiffening.hpp"
#include "sim/model/effects/tendon/stiffness.hpp"

namespace sim::effects {

// clang-format off
/// In the order of the chain, which is also the order in which they act.
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
