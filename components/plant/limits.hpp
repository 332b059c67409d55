#pragma once
#include <string_view>

#include "interfaces/robot/robot.hpp"
#include "interfaces/values.hpp"

/// Checks the references of an actuator.
///
/// A reference up to twice the limit is clamped to the limit, counted and reported (`limited`). An
/// invalid reference (NaN, unknown mode, negative force, more than twice the limit) is refused: the
/// previous command stays and becomes stale.
namespace plant {

enum class Verdict { accepted, limited, refused };

struct Checked {
  Verdict verdict;
  double reference;         ///< within the limits, unless refused
  std::string_view reason;  ///< static text; empty when accepted
};

class Limits {
 public:
  /// Throws std::invalid_argument when the tension limit exceeds the range of its sensor.
  Limits(const erp::Actuator& actuator, const erp::MotorType& motor,
         const erp::SensorType& sensors);
  Checked check(erp::Mode mode, double reference) const;

  /// Largest change of line length from the start, in m. Chosen; within the ±8 turns of an ECU's
  /// 22-bit length set-point.
  static constexpr double max_line_m = 0.2;

 private:
  double supply_V_, current_A_, tension_N_;
};

}  // namespace plant
