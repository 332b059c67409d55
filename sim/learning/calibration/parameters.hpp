#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"

/// The uncertain parameters of a robot as normalised numbers x_i (paper, 4.4): 0 is the value of
/// robot.xml, 1 differs from it by the expected spread.
///
///   attachments   A, B: first and last point of a tendon    x_i m, each of three axes
///   length        L_K0                                      m, added to the length from robot.xml:
///                                                           the effect `tendon_length_offset`
///   stiffness     κ                                         κ exp(spread x)
///   radius        r of the spindle                          r exp(spread x)
namespace sim::calibration {

enum class Quantity { attachments, length, stiffness, radius };

/// One `<vary>` of a calibration's file.
struct Vary {
  static constexpr auto element = "vary";
  static constexpr auto description = "Quantity to identify.";
  xml::Place place;
  Quantity what = Quantity::attachments;
  std::string on = "*";
  double spread = 0;
  void visit(auto& v) {
    v.required("what", what,
               "Quantity to identify: attachments of the tendon, line length, stiffness, or radius "
               "of the spindle.");
    v("on", on, "Actuator; *: all.");
    v.required(
        "spread", spread,
        {xml::positive, "Expected standard deviation, in m; relative for stiffness and radius."});
  }
};

/// `<calibration>`, a file.
struct Choice {
  static constexpr auto element = "calibration";
  static constexpr auto description = "Quantities that erp calibrate run identifies.";
  xml::Place place;
  std::vector<Vary> list;
  void visit(auto& v) { v.list(list); }
};

/// One number to identify.
struct Parameter {
  std::size_t actuator = 0;
  Quantity what = Quantity::attachments;
  int axis = 0;  ///< of attachments: 0 … 2: A, 3 … 5: B
  double spread = 0;
};

/// A robot with other parameters; its line lengths are offsets to those that follow from its
/// pretensions.
struct Candidate {
  erp::Robot robot;                     ///< without its effects `tendon_length_offset`
  std::vector<double> length_offset_m;  ///< by actuator
};

class Parameters {
 public:
  /// Begins at the robot's line lengths; its other effects do not change. Throws xml::Errors for an
  /// actuator that does not exist or is chosen twice.
  Parameters(erp::Robot robot, const Choice& choice);

  Eigen::Index size() const { return static_cast<Eigen::Index>(list_.size()); }
  const std::vector<Parameter>& list() const { return list_; }
  /// "biceps: A x, mm".
  std::string name_of(const Parameter& parameter) const;
  /// Throws std::invalid_argument if a length offset exceeds the bound of its effect.
  Candidate at(const Eigen::VectorXd& x) const;
  /// The robot of robot.xml: at(0).
  Candidate start() const { return {robot_, length_offset_m_}; }
  /// The same as one robot.xml, with length offsets as effects `tendon_length_offset`.
  erp::Robot robot_at(const Eigen::VectorXd& x) const;

 private:
  void choose(const Vary& vary);

  erp::Robot robot_;                     ///< without its effects `tendon_length_offset`
  std::vector<double> length_offset_m_;  ///< the values of those effects
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
