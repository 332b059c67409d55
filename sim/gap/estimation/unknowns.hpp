#pragma once
#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "sim/gap/estimation/constants.hpp"

/// The unknowns of a robot: its constants, then the parameters of its effects.
namespace sim::estimation {

/// A robot and its uncertain constants.
struct Uncertain {
  erp::Robot nominal;
  std::vector<Constant> constants;
  /// For each constant, whether it is far off (far_off.hpp); empty: not yet decided.
  std::vector<bool> far = {};
};

/// Values of the unknowns.
struct Point {
  std::vector<double> x;                 ///< one per constant, in tolerances
  std::vector<effects::Placed> effects;  ///< with the values of their parameters
};

/// Returns the robot with the values of a point.
erp::Robot robot_at(const Uncertain& uncertain, const Point& point);

/// −2 log of the prior of x:
///
///   ν log(1 + x²/ν), ν = 6   while the constants far off are not yet decided (Student's t)
///   x²                       constants within their tolerances
///   x²/far_sigma² + price    constants far off
///
/// Student's t is near the normal distribution for small x. A constant far off costs little more
/// than one that is three tolerances off.
double prior_cost(const Uncertain& uncertain, const Point& point);
/// Precision of the normal distribution with the same slope at the point, for constant k.
double prior_precision(const Uncertain& uncertain, const Point& point, std::size_t k);

inline double far_precision(const Constant& c) { return 1 / (c.far_sigma * c.far_sigma); }
/// Price of a constant far off: −2 log of its odds, 15 %, plus the normalization of the wider
/// prior. For a zero, the cost of five tolerances. Chosen.
inline double far_price(const Constant& c) { return c.zero ? 25 : 3.5 + 2 * std::log(c.far_sigma); }

/// Whether a parameter is estimated here: all fitted parameters, and times and speeds, which the
/// diagnosis scans. Numbers of periods are not estimated.
bool is_estimated(const effects::Parameter& parameter);

/// The coordinates of a point: x, then the estimated parameters. Times and speeds are represented
/// by their logarithm.
class Unknowns {
 public:
  /// `uncertain` must outlive this object.
  Unknowns(const Uncertain& uncertain, Point at);

  std::size_t count() const { return at_.x.size() + places_.size(); }
  std::size_t constants() const { return at_.x.size(); }
  const Uncertain& uncertain() const { return *uncertain_; }
  const Point& point() const { return at_; }
  erp::Robot robot() const { return robot_at(*uncertain_, at_); }

  double value(std::size_t k) const;
  /// Step of a forward difference, within the bounds. It is so small that windows rarely enter or
  /// leave a friction band, and tendons rarely become taut or slack. `stretch`: factor of the step.
  double step(std::size_t k, double stretch = 1) const;
  /// Return a copy with another value of one unknown, or after a step of all unknowns. Parameters
  /// are limited to their bounds.
  Unknowns with(std::size_t k, double value) const;
  Unknowns moved(const Eigen::VectorXd& by) const;
  residuals::Reach reach(std::size_t k, const residuals::Stages& stages) const;
  bool at_bound(std::size_t k) const;
  bool is_logarithm(std::size_t k) const { return k >= constants() && !parameter(k).fitted; }

 private:
  struct Place {
    std::size_t effect, parameter;
  };
  effects::Parameter parameter(std::size_t k) const;

  const Uncertain* uncertain_;
  Point at_;
  std::vector<Place> places_;
};

}  // namespace sim::estimation
