#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"

/// What of a robot is not well known, as normalised numbers (paper, 4.4): 0 is what robot.xml says,
/// 1 is off by the spread that is expected.
///
///   attachments   A, B: first and last point of a tendon    x_i m, each of three axes
///   length        L_K0                                      m, beside what robot.xml makes of it:
///                                                           its effect `tendon_length_offset`
///   stiffness     κ                                         κ exp(spread x)
///   radius        r of the spindle                          r exp(spread x)
namespace sim::calibration {

enum class Quantity { attachments, length, stiffness, radius };

/// One `<vary>` of a calibration's file.
struct Vary {
  static constexpr auto element = "vary";
  xml::Place place;
  Quantity what = Quantity::attachments;
  std::string on = "*";  ///< an actuator; all of them
  double spread = 0;     ///< m; of stiffness and radius relative
  void visit(auto& v) {
    v.required("what", what);
    v("on", on);
    v.required("spread", spread, xml::positive);
  }
};

/// `<calibration>`, a file.
struct Choice {
  static constexpr auto element = "calibration";
  xml::Place place;
  std::vector<Vary> list;
  void visit(auto& v) { v.list(list); }
};

/// One number that is looked for.
struct Parameter {
  std::size_t actuator = 0;
  Quantity what = Quantity::attachments;
  int axis = 0;  ///< of attachments: 0 … 2 of A, 3 … 5 of B
  double spread = 0;
};

/// A robot with other parameters; lengths beside those that follow from its pretensions.
struct Candidate {
  erp::Robot robot;              ///< without effects of that
  std::vector<double> longer_m;  ///< by actuator
};

class Parameters {
 public:
  /// Begins at the robot's lengths; its other effects stay as they are. Throws xml::Errors for an
  /// actuator that there is not, or that is chosen twice.
  Parameters(erp::Robot robot, const Choice& choice);

  Eigen::Index size() const { return static_cast<Eigen::Index>(list_.size()); }
  const std::vector<Parameter>& list() const { return list_; }
  /// "biceps: A x, mm".
  std::string name_of(const Parameter& parameter) const;
  /// Throws std::invalid_argument where a length is off by more than its effect may be.
  Candidate at(const Eigen::VectorXd& x) const;
  /// As robot.xml has it: at(0).
  Candidate start() const { return {robot_, longer_m_}; }
  /// The same as one robot.xml: lengths as effects `tendon_length_offset`.
  erp::Robot robot_at(const Eigen::VectorXd& x) const;

 private:
  void choose(const Vary& vary);

  erp::Robot robot_;              ///< without its effects of length
  std::vector<double> longer_m_;  ///< that those had
  std::vector<Parameter> list_;
};

}  // namespace sim::calibration

template <>
struct xml::Names<sim::calibration::Quantity> {
  using Quantity = sim::calibration::Quantity;
  static constexpr auto list =
      std::to_array<std::pair<const char*, Quantity>>({{"attachments", Quantity::attachments},
                                                       {"length", Quantity::length},
                                                       {"stiffness", Quantity::stiffness},
                                                       {"radius", Quantity::radius}});
};
