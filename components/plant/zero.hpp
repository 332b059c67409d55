#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "firmware/core/ecu.h"
#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"

/// The zero of one actuator's encoder. An encoder counts from 0 at the reset of its ECU, wherever the
/// shaft is. The zero is known once the ECU has been given the counts to add, so that the shaft angle
/// is 0 where the line is as long as in the starting pose. The ECU stores it, so it survives a restart
/// of the plant.
///
///   unknown --set--> sent to the ECU, every 100 ms --the ECU confirms--> known --its reset--> unknown
///
/// An absolute potentiometer on the gearbox output sets an unknown zero by itself (paper, eq. 5).
/// Reads no clock.
namespace plant {

class Zero {
 public:
  enum class Change { none, lost, set, unconfirmed };

  /// `potentiometer`: of this actuator; null if it has none.
  Zero(const erp::Actuator& actuator, double shaft_rad_per_count,
       const erp::Potentiometer* potentiometer);

  bool is_known() const { return known_; }
  bool has_potentiometer() const { return range_rad_ > 0; }

  /// Processes a report of the ECU. `lost` at the first report of an unknown zero, and when a known
  /// zero becomes unknown.
  Change observe(bool known, ecu_state state, std::int32_t counts, std::int64_t now_ns);
  /// Processes a reading of the potentiometer, taken together with the last report.
  void observe_potentiometer(double reading_rad, std::int64_t now_ns);
  /// Gives the shaft the angle `shaft_rad` at its present position; `source` is named in the report.
  /// The shaft must stand still if the zero is known.
  void set(double shaft_rad, const std::string& source, std::int64_t now_ns);
  /// Appends the zero to be sent, if there is one and it is due.
  void append_next(erp::EcuParameter& message, std::int64_t now_ns);
  /// The source of the last zero that was set.
  const std::string& source() const { return source_; }

 private:
  std::uint8_t ecu_, channel_;
  double rad_per_count_, range_rad_ = 0, start_rad_ = 0;
  bool known_ = false, observed_ = false;
  std::int32_t counts_ = 0;
  ecu_state state_ = ECU_STATE_BOOT;
  std::optional<double> wanted_rad_;        ///< to be set
  std::optional<std::int32_t> add_counts_;  ///< sent to the ECU
  std::int64_t wanted_since_ns_ = 0, sent_ns_ = 0;
  int readings_ = 0;
  double sum_rad_ = 0;  ///< of the differences between potentiometer and encoder
  std::string source_;
};

}  // namespace plant
