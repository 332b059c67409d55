#pragma once
#include <string_view>

#include "interfaces/robot/robot.hpp"
#include "interfaces/values.hpp"

/// What an actuator may be asked for.
///
/// A reference a little outside is brought to the limit, counted and said (`limited`). One that no
/// sane controller sends — NaN, an unknown mode, a negative force, more than twice the limit — is
/// refused whole: the old command stays and goes stale.
namespace plant {

enum class Verdict { accepted, limited, refused };

struct Checked {
  Verdict verdict;
  double reference;         ///< within the limits, unless refused
  std::string_view reason;  ///< static text; empty when accepted
};

class Limits {
 public:
  /// Throws std::invalid_argument when the tension limit exceeds what its sensor can see.
  Limits(const erp::Actuator& actuator, const erp::MotorType& motor,
         const erp::SensorType& sensors);
  Checked check(erp::Mode mode, double reference) const;

  /// Line the spindle may wind or let out from where it started; chosen: 0.2 m, within the ±8
  /// turns an ECU's 22-bit length set-point covers.
  static constexpr double max_line_m = 0.2;

 private:
  double supply_V_, current_A_, tension_N_;
};

}  // namespace plant
