#pragma once
#include <cmath>
#include <string>
#include <vector>

/// Deviations of the simulator from closed-form solutions.
namespace accuracy {

/// One row of the table.
struct Figure {
  int test;
  std::string description;
  double deviation, limit;
  std::string unit;  ///< unit of `deviation` and `limit`; empty: a ratio
};
using Figures = std::vector<Figure>;

Figures sphere_wrap();           ///< test 1
Figures quarter_turn();          ///< test 2
Figures muscle_jacobian();       ///< test 3
Figures motor();                 ///< test 4
Figures suspended_mass();        ///< test 5
Figures pendulum();              ///< test 6
Figures free_arm();              ///< test 7
Figures dynamics();              ///< test 8
Figures order_and_repetition();  ///< test 9

/// Returns the larger value; NaN if one is NaN.
inline double larger(double worst, double value) {
  return value <= worst || std::isnan(worst) ? worst : value;
}

/// |value / exact − 1|
inline double relative_error(double value, double exact) { return std::abs(value / exact - 1); }

}  // namespace accuracy
