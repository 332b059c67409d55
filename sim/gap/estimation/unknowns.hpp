#pragma once
#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "sim/gap/estimation/constants.hpp"

/// What is estimated of a robot: its constants, then the parameters of effects beside them.
namespace sim::estimation {

/// A robot and what is uncertain about it.
struct Uncertain {
  erp::Robot nominal;
  std::vector<Constant> constants;
  /// Of each constant whether it is far off (far_off.hpp); empty: not known yet.
  std::vector<bool> far = {};
};

/// A point among what is possible.
struct Point {
  std::vector<double> x;                 ///< one a constant, in tolerances
  std::vector<effects::Placed> effects;  ///< with their parameters
};

erp::Robot robot_at(const Uncertain& uncertain, const Point& point);

/// −2 log of the prior of x. Where it is not known which constants are far off, ν log(1 + x²/ν), ν = 6: a
/// normal one of standard deviation 1 near 0, with the heavier tails of Student's t, so that a constant
/// far off costs little more than one that is three tolerances off. Where it is known, x², and
/// x²/far² + price of one that is far off.
double prior_cost(const Uncertain& uncertain, const Point& point);
/// Of the normal one that has the same slope there.
double prior_precision(const Uncertain& uncertain, const Point& point, std::size_t k);

inline double far_precision(const Constant& c) { return 1 / (c.far * c.far); }
/// −2 log of the odds that a constant is far off, 15 %, and of the normalisation of the wider prior; of a
/// zero five tolerances; chosen.
inline double far_price(const Constant& c) { return c.zero ? 25 : 3.5 + 2 * std::log(c.far); }

/// Parameters that are fitted, and times and speeds that are given elsewhere; not counts (a cogging's
/// periods).
bool is_estimated(const effects::Parameter& parameter);

/// A point's coordinates one after the other: x, then each estimated parameter, the logarithm of one that is
/// not fitted elsewhere.
class Unknowns {
 public:
  /// `uncertain` stays with the caller.
  Unknowns(const Uncertain& uncertain, Point at);

  std::size_t count() const { return at_.x.size() + places_.size(); }
  std::size_t constants() const { return at_.x.size(); }
  const Uncertain& uncertain() const { return *uncertain_; }
  const Point& point() const { return at_; }
  erp::Robot robot() const { return robot_at(*uncertain_, at_); }

  double value(std::size_t k) const;
  /// For a forward difference, within the bounds: so small that all unknowns have the same windows beyond a band
  /// of friction, and the same with a line taut.
  double step(std::size_t k, double stretch = 1) const;
  /// Another value of one, or all moved; parameters stay within their bounds.
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
