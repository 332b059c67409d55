#pragma once
#include <Eigen/Core>
#include <map>
#include <span>
#include <vector>

#include "interfaces/values.hpp"
#include "sim/gap/residuals/episode.hpp"

/// The control law of an ECU with another firmware, learned from recordings, so that a free run can use it. For
/// each actuator and mode
///
///   V(k) = w · φ(k − l),   φ = (1, ref, dref/dt, y, dy/dt, ∫(ref − y) dt, ω, i, F),   |V| ≤ supply
///
/// y: controlled quantity of the mode (line wound −r θ, current or tension), ω: shaft speed, l: delay in rows.
/// ref is taken from the row after that of the sensors, or from the same row, whichever explains more. w: least
/// squares over rows below the supply voltage.
namespace sim::closed_loop {

/// Inputs of an ECU in one row.
struct EcuInput {
  double reference = 0, shaft_rad = 0, current_A = 0, tension_N = 0;
};

/// Regressors φ of one law, row by row since the start of its mode.
class Regressors {
 public:
  static constexpr int count = 9;
  Regressors(erp::Mode mode, double radius_m) : mode_(mode), radius_m_(radius_m) {}
  Eigen::Vector<double, count> next(const EcuInput& known);

 private:
  erp::Mode mode_;
  double radius_m_;
  bool begun_ = false;
  EcuInput last_;
  double last_y_ = 0, integral_ = 0;
};

struct LearnedLaw {
  Eigen::Vector<double, Regressors::count> weights;
  std::size_t lag = 1;     ///< rows
  bool newest = true;      ///< the reference is from the row after that of the sensors
  double unexplained = 1;  ///< share of the variance of the voltage
};

/// By actuator and mode.
using LearnedEcu = std::map<std::pair<std::size_t, erp::Mode>, LearnedLaw>;

/// Laws of the modes voltage, length, current and force that are recorded for at least one second.
LearnedEcu learn(std::span<const residuals::Episode> recordings, const erp::Robot& robot);

/// Share of the variance of the voltages that this product's firmware, with the gains designed for `robot`, does
/// not predict from the measurements. It uses the newest commands or, if that share exceeds `enough`, commands
/// of a constant age (up to 60 ms) whose share is below a tenth of `enough`. Near 0 for recordings of this
/// firmware, even with a delayed bus; 1 if there is too little data.
double unexplained_by_firmware(std::span<const residuals::Episode> recordings,
                               const erp::Robot& robot, double enough = 0.05);

}  // namespace sim::closed_loop
