#pragma once
#include <memory>
#include <string>

#include "interfaces/xml/fields.hpp"
#include "sim/learning/experience/base.hpp"

/// What is superimposed when the pattern has ended and the hand is still off by ΔX.
namespace sim::experience {

enum class FeedbackKind { none, linear, fuzzy };

class Feedback {
 public:
  virtual ~Feedback() = default;
  /// By drive. `off_m` is target less hand, `off_m_per_s` how that changes.
  virtual Eigen::VectorXd drives_V(const Eigen::Vector3d& off_m,
                                   const Eigen::Vector3d& off_m_per_s) const = 0;
};

/// ΔV = b K ΔX (eq. 10): K the weighted inverse of the influence about the stored experience that is
/// nearest to the target; b, 1/s, how fast it closes.
std::unique_ptr<Feedback> linear_feedback(const Base& base, int start,
                                          const Eigen::Vector3d& target_m, double closing_per_s);

/// ΔV = K_Jac ΔV_fuzzy (eq. 9). K_Jac: the same inverse of the whole base's influence, scaled so that
/// its largest number is 1; ΔV_fuzzy, V, by the rules of a file in the FuzzyLite language, for each of
/// x, y, z: inputs off_m, off_m_per_s, output voltage_V. Throws std::invalid_argument: a file that
/// cannot be read, or has others.
std::unique_ptr<Feedback> fuzzy_feedback(const Base& base, int start, const std::string& fll_file);

}  // namespace sim::experience

template <>
struct xml::Names<sim::experience::FeedbackKind> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::experience::FeedbackKind>>(
      {{"none", sim::experience::FeedbackKind::none},
       {"linear", sim::experience::FeedbackKind::linear},
       {"fuzzy", sim::experience::FeedbackKind::fuzzy}});
};
