#pragma once
#include <Eigen/Core>
#include <map>
#include <span>
#include <vector>

#include "interfaces/values.hpp"
#include "sim/gap/residuals/episode.hpp"

/// The control law of an ECU with another firmware, learned from recordings for use in a free run.
/// For each actuator and mode:
///
///   V(k) = w · φ(k − l),   φ = (1, ref, dref/dt, y, dy/dt, ∫(ref − y) dt, ω, i, F),   |V| ≤ supply
///
/// y: controlled quantity of the mode (line wound −r θ, current or tension), ω: shaft speed, l:
/// delay in rows. ref is taken from the row of the sensors or from the next row; the variant that
/// explains more is used. w is computed by least squares over rows below the supply voltage.
namespace sim::closed_loop {

/// Inputs of an ECU in one row.
struct EcuInput {
  double reference = 0, shaft_rad = 0, current_A = 0, tension_N = 0;
};

/// Computes the regressors φ of one law, row by row from the start of its mode.
class Regressors {
 public:
  static constexpr int count = 9;
  Regressors(erp::Mode mode, double radius_m) : mode_(mode), radius_m_(radius_m) {}
  /// Returns φ of the next row.
  Eigen::Vector<double, count> next(const EcuInput& input);

 private:
  erp::Mode mode_;
  double radius_m_;
  bool started_ = false;
  EcuInput last_;
  double last_y_ = 0, integral_ = 0;
};

struct LearnedLaw {
  Eigen::Vector<double, Regressors::count> weights;
  std::size_t lag = 1;     ///< rows
  bool newest = true;      ///< the reference is from the row after the sensors' row
  double unexplained = 1;  ///< fraction of the variance of the voltage
};

/// By actuator and mode.
using LearnedEcu = std::map<std::pair<std::size_t, erp::Mode>, LearnedLaw>;

/// Learns the laws of the modes voltage, length, current and force that are recorded for at least
/// one second.
LearnedEcu learn(std::span<const residuals::Episode> recordings, const erp::Robot& robot);

/// Returns the fraction of the variance of the voltages that this product's firmware, with the
/// gains designed for `robot`, does not predict from the measurements. The newest commands are
/// used. If the fraction exceeds `tolerated_fraction`, commands of a constant age (up to 60 ms) are
/// used if their fraction is below a tenth of `tolerated_fraction`. The result is near 0 for
/// recordings of this firmware, even with a delayed bus; 1 if there is too little data.
double unexplained_by_firmware(std::span<const residuals::Episode> recordings,
                               const erp::Robot& robot, double tolerated_fraction = 0.05);

}  // namespace sim::closed_loop
