#pragma once
#include <Eigen/Core>
#include <map>
#include <span>
#include <vector>

#include "interfaces/values.hpp"
#include "sim/gap/residuals/episode.hpp"

/// The control law of an ECU that is not this product's firmware, learned from recordings, so that a robot
/// can be run freely under its own ECU. Of each actuator and mode
///
///   V(k) = w · φ(k − l),   φ = (1, ref, dref/dt, y, dy/dt, ∫(ref − y) dt, ω, i, F),   |V| ≤ supply
///
/// y: what the mode controls (line wound −r θ, current or tension), ω: the shaft's speed, l: rows that
/// the law needs. ref is that of the row after the sensors', which asks for the voltage, or that of the
/// same row, whichever explains more. w by least squares over rows that are not clipped.
namespace sim::closed_loop {

/// What an ECU knows after a row.
struct Known {
  double reference = 0, shaft_rad = 0, current_A = 0, tension_N = 0;
};

/// One law's inputs, row by row since its mode began.
class Regressors {
 public:
  static constexpr int count = 9;
  Regressors(erp::Mode mode, double radius_m) : mode_(mode), radius_m_(radius_m) {}
  Eigen::Vector<double, count> next(const Known& known);

 private:
  erp::Mode mode_;
  double radius_m_;
  bool begun_ = false;
  Known last_;
  double last_y_ = 0, integral_ = 0;
};

struct LearnedLaw {
  Eigen::Vector<double, Regressors::count> weights;
  std::size_t lag = 1;     ///< rows
  bool newest = true;      ///< the reference is that of the row after the sensors'
  double unexplained = 1;  ///< share of the voltage's variance
};

/// By actuator and mode.
using LearnedEcu = std::map<std::pair<std::size_t, erp::Mode>, LearnedLaw>;

/// Laws of the modes voltage, length, current and force that recordings show for a second or more.
LearnedEcu learn(std::span<const residuals::Episode> recordings, const erp::Robot& robot);

/// Share of the voltages' variance that this product's firmware, with the gains designed for `robot`,
/// does not predict from what was measured: with the newest commands or, where that is more than
/// `enough`, with those of one age (up to 60 ms) that leaves less than a tenth of `enough`. Near 0 if
/// the recordings are of it, on a bus however late; 1: nothing to judge by.
double unexplained_by_firmware(std::span<const residuals::Episode> recordings,
                               const erp::Robot& robot, double enough = 0.05);

}  // namespace sim::closed_loop
