#pragma once
#include <cmath>
#include <string>
#include <vector>

/// Errors of the simulator against closed-form solutions.
namespace accuracy {

struct Figure {
  int test;
  std::string what;
  double found, allowed;
  std::string unit;  ///< unit of `found` and `allowed`; empty: a ratio
};
using Figures = std::vector<Figure>;

Figures sphere_wrap();           ///< test 1
Figures quarter_turn();          ///< test 2
Figures muscle_jacobian();       ///< test 3
Figures motor();                 ///< test 4
Figures hung_mass();             ///< test 5
Figures pendulum();              ///< test 6
Figures free_arm();              ///< test 7
Figures dynamics();              ///< test 8
Figures order_and_repetition();  ///< test 9

/// The larger value; NaN if one is NaN.
inline double larger(double worst, double found) {
  return found <= worst || std::isnan(worst) ? worst : found;
}

/// |found / exact − 1|
inline double relative(double found, double exact) { return std::abs(found / exact - 1); }

}  // namespace accuracy
