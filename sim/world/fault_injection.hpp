#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "firmware/core/sensing.h"
#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/fields.hpp"
#include "sim/model/actuator/sensors.hpp"
#include "sim/world/world.hpp"

/// Faults of a simulated robot, injected at given times. They serve training and tests of the safe
/// state.
namespace sim {

enum class FaultKind {
  tension_open,   ///< force sensor at its upper rail
  tension_short,  ///< force sensor at 0 counts
  tension_stuck,  ///< force reading frozen
  current_stuck,  ///< current reading frozen
  encoder_lost,   ///< loss of a phase: counts frozen
  encoder_slips,  ///< counts jump by a quarter turn of the gearbox shaft
  over_current,   ///< Hall sensor at its rail
  hot,            ///< temperature reading of `counts`
  supply_low,     ///< supply reading of `counts`
  reset,          ///< of the ECU (virtual ECUs): it boots, and its encoders count from 0
  tendon_snaps,   ///< the tendon exerts no tension from then on
  hang,           ///< separate ECU only: its program is in an endless loop
  busy,           ///< separate ECU only: work takes longer than a period
  bus_off         ///< separate ECU only: its CAN controller is in bus-off
};

/// `<fault kind="tension_open" on="flexor" at_s="2" for_s="0.5"/>` in the sim's config.
struct InjectedFault {
  static constexpr auto element = "fault", former_element = "mishap";
  static constexpr auto description = "Fault of the simulated robot.";
  xml::Place place;
  FaultKind kind = FaultKind::tension_open;
  std::string on;
  double at_s = 0;
  double for_s = 1e9;
  int counts = 0;
  void visit(auto& v) {
    v.required("kind", kind, "Fault; sim/world/README.md describes each.");
    v.required("on", on, "Actuator of the fault; for reset, hang, busy and bus_off its ECU.");
    v.required("at_s", at_s, {xml::at_least_zero, "Simulated time at which the fault begins."});
    v("for_s", for_s, {xml::positive, "Length of the fault."});
    v("counts", counts, {xml::Range{0, 65535}, "Reading in counts; used by hot and supply_low."});
  }
};

class FaultInjection {
 public:
  /// Throws std::invalid_argument for an actuator that the robot does not have.
  FaultInjection(std::vector<InjectedFault> list, const erp::Robot& robot);

  /// Changes the readings of actuator `k`'s ECU; `last` are its previous readings.
  void apply_fault(std::size_t k, double time_s, const SensorScale& scale, const ecu_inputs& last,
                   ecu_inputs& inputs) const;
  /// Applies the faults of the world (snapped tendons) whose time has come.
  void apply_fault(World& world) const;

  struct ProgramFault {
    FaultKind kind;
    int ecu;
    int periods;
  };
  /// Faults of ECU programs that begin in the tick at `time_s`.
  std::vector<ProgramFault> program_faults(double time_s, double tick_s) const;
  struct Beginning {
    const InjectedFault* fault;
    int ecu;
  };
  /// All faults that begin in the tick at `time_s`.
  std::vector<Beginning> beginning(double time_s, double tick_s) const;
  bool has(FaultKind kind) const;
  bool empty() const { return list_.empty(); }
  /// Whether the list contains a fault of an ECU program, which needs a separate ECU.
  bool needs_separate_ecus() const;

 private:
  struct Placed {
    InjectedFault fault;
    std::size_t actuator;
    int ecu;
  };
  static bool begins(const InjectedFault& injected, double time_s, double tick_s) {
    return injected.at_s >= time_s && injected.at_s < time_s + tick_s;
  }
  static bool is_active(const InjectedFault& injected, double time_s) {
    return time_s >= injected.at_s && time_s < injected.at_s + injected.for_s;
  }
  std::vector<Placed> list_;
};

}  // namespace sim

template <>
struct xml::Names<sim::FaultKind> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::FaultKind>>(
      {{"tension_open", sim::FaultKind::tension_open},
       {"tension_short", sim::FaultKind::tension_short},
       {"tension_stuck", sim::FaultKind::tension_stuck},
       {"current_stuck", sim::FaultKind::current_stuck},
       {"encoder_lost", sim::FaultKind::encoder_lost},
       {"encoder_slips", sim::FaultKind::encoder_slips},
       {"over_current", sim::FaultKind::over_current},
       {"hot", sim::FaultKind::hot},
       {"supply_low", sim::FaultKind::supply_low},
       {"reset", sim::FaultKind::reset},
       {"tendon_snaps", sim::FaultKind::tendon_snaps},
       {"hang", sim::FaultKind::hang},
       {"busy", sim::FaultKind::busy},
       {"bus_off", sim::FaultKind::bus_off}});
};
