#pragma once
#include <Eigen/Core>
#include <vector>

#include "sim/gap/constants.hpp"

/// What is estimated of a robot: its constants, then the parameters of effects beside them.
namespace sim::gap {

/// A robot and what is uncertain about it.
struct Uncertain {
  erp::Robot nominal;
  std::vector<Constant> constants;
  std::vector<double> prior;  ///< standard deviations of x, one a constant; 1: its tolerance
};

/// A point among what is possible.
struct Point {
  std::vector<double> x;                 ///< one a constant, in tolerances
  std::vector<effects::Placed> effects;  ///< with their parameters
};

erp::Robot robot_at(const Uncertain& uncertain, const Point& point);

/// A point's coordinates one after the other: x, then each parameter. Parameters of effects that are
/// counts (a cogging's periods) are none.
class Unknowns {
 public:
  /// `uncertain` stays with the caller.
  Unknowns(const Uncertain& uncertain, Point at);

  std::size_t count() const { return at_.x.size() + places_.size(); }
  std::size_t constants() const { return at_.x.size(); }
  const Point& point() const { return at_; }
  erp::Robot robot() const { return robot_at(*uncertain_, at_); }

  double value(std::size_t k) const;
  double prior(std::size_t constant) const { return uncertain_->prior[constant]; }
  /// For a forward difference, within the bounds.
  double step(std::size_t k) const;
  /// Another value of one, or all moved; parameters stay within their bounds.
  Unknowns with(std::size_t k, double value) const;
  Unknowns moved(const Eigen::VectorXd& by) const;
  residuals::Reach reach(std::size_t k, const residuals::Stages& stages) const;
  bool at_bound(std::size_t k) const;

 private:
  struct Place {
    std::size_t effect, parameter;
  };
  effects::Parameter parameter(std::size_t k) const;

  const Uncertain* uncertain_;
  Point at_;
  std::vector<Place> places_;
};

}  // namespace sim::gap
