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

/// What breaks in a simulated robot, and when: for practice, and to see that it ends safely.
namespace sim {

enum class MishapKind {
  tension_open,   ///< force sensor at its upper rail
  tension_short,  ///< force sensor at 0 counts
  tension_stuck,  ///< force reading stays where it is
  current_stuck,  ///< current reading stays where it is
  encoder_lost,   ///< a phase is gone: counts stay where they are
  encoder_slips,  ///< counts jump by a quarter turn of the gearbox shaft
  over_current,   ///< Hall sensor at its rail
  hot,            ///< temperature reading of `counts`
  supply_low,     ///< supply reading of `counts`
  tendon_snaps,   ///< pulls no more, for good
  hang,           ///< of a separate ECU: its program, in an endless loop
  busy,           ///< of a separate ECU: each period works longer than a period
  bus_off         ///< of a separate ECU: its CAN controller is off the bus
};

/// `<mishap kind="tension_open" on="flexor" at_s="2" for_s="0.5"/>` in the sim's config.
struct Mishap {
  static constexpr auto element = "mishap";
  xml::Place place;
  MishapKind kind = MishapKind::tension_open;
  std::string on;   ///< which actuator; of hang, busy and bus_off its ECU is meant
  double at_s = 0;  ///< of simulated time
  double for_s = 1e9;
  int counts = 0;  ///< for hot and supply_low
  void visit(auto& v) {
    v.required("kind", kind);
    v.required("on", on);
    v.required("at_s", at_s, xml::at_least_zero);
    v("for_s", for_s, xml::positive);
    v("counts", counts, xml::Range{0, 65535});
  }
};

class Mishaps {
 public:
  /// Throws std::invalid_argument for an actuator that the robot does not have.
  Mishaps(std::vector<Mishap> list, const erp::Robot& robot);

  /// Changes what actuator `k`'s ECU reads; `last` is what it read before.
  void befall(std::size_t k, double time_s, const SensorScale& scale, const ecu_inputs& last,
              ecu_inputs& inputs) const;
  /// Breaks what is due in the world itself.
  void befall(World& world) const;

  struct OfEcu {
    MishapKind kind;
    int ecu;
    int periods;
  };
  /// What befalls programs in the tick that begins at `time_s`.
  std::vector<OfEcu> of_ecus(double time_s, double tick_s) const;
  /// Those that begin in the tick at `time_s`.
  std::vector<const Mishap*> beginning(double time_s, double tick_s) const;
  bool empty() const { return list_.empty(); }
  /// One that befalls a program, which only a separate ECU has.
  bool needs_separate_ecus() const;

 private:
  struct Placed {
    Mishap what;
    std::size_t actuator;
    int ecu;
  };
  static bool begins(const Mishap& m, double time_s, double tick_s) {
    return m.at_s >= time_s && m.at_s < time_s + tick_s;
  }
  static bool is_on(const Mishap& m, double time_s) {
    return time_s >= m.at_s && time_s < m.at_s + m.for_s;
  }
  std::vector<Placed> list_;
};

}  // namespace sim

template <>
struct xml::Names<sim::MishapKind> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::MishapKind>>(
      {{"tension_open", sim::MishapKind::tension_open},
       {"tension_short", sim::MishapKind::tension_short},
       {"tension_stuck", sim::MishapKind::tension_stuck},
       {"current_stuck", sim::MishapKind::current_stuck},
       {"encoder_lost", sim::MishapKind::encoder_lost},
       {"encoder_slips", sim::MishapKind::encoder_slips},
       {"over_current", sim::MishapKind::over_current},
       {"hot", sim::MishapKind::hot},
       {"supply_low", sim::MishapKind::supply_low},
       {"tendon_snaps", sim::MishapKind::tendon_snaps},
       {"hang", sim::MishapKind::hang},
       {"busy", sim::MishapKind::busy},
       {"bus_off", sim::MishapKind::bus_off}});
};
