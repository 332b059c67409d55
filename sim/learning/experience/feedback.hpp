#pragma once
#include <memory>
#include <string>

#include "interfaces/xml/fields.hpp"
#include "sim/learning/experience/base.hpp"

/// Feedback voltages that correct the remaining offset ΔX of the hand after the pattern has ended.
namespace sim::experience {

enum class FeedbackKind { none, linear, fuzzy };

class Feedback {
 public:
  virtual ~Feedback() = default;
  /// Voltage by drive. `off_m` is target minus hand position, `off_m_per_s` its rate of change.
  virtual Eigen::VectorXd drives_V(const Eigen::Vector3d& off_m,
                                   const Eigen::Vector3d& off_m_per_s) const = 0;
};

/// ΔV = b K ΔX (eq. 10): K is the weighted inverse of the influence near the stored experience that
/// is nearest to the target; b, in 1/s, is the rate at which the offset decreases.
std::unique_ptr<Feedback> linear_feedback(const Base& base, int start,
                                          const Eigen::Vector3d& target_m, double gain_per_s);

/// ΔV = K_Jac ΔV_fuzzy (eq. 9). K_Jac is the weighted inverse of the whole base's influence, scaled
/// so that its largest element is 1. ΔV_fuzzy, in V, follows for each of x, y, z from the rules of
/// a file in the FuzzyLite language with inputs off_m, off_m_per_s and output voltage_V. Throws
/// std::invalid_argument if the file cannot be read or has other variables.
std::unique_ptr<Feedback> fuzzy_feedback(const Base& base, int start, const std::string& fll_file);

}  // namespace sim::experience

template <>
struct xml::Names<sim::experience::FeedbackKind> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::experience::FeedbackKind>>(
      {{"none", sim::experience::FeedbackKind::none},
       {"linear", sim::experience::FeedbackKind::linear},
       {"fuzzy", sim::experience::FeedbackKind::fuzzy}});
};
