#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "interfaces/xml/plural.hpp"

/// Voltage patterns modelled on electromyograms of fast reaches, distributed over muscles and
/// scaled.
///
///   V_m(t) = Σ_d s_d w_md e±(t),   ∫ e± dt = 1
///
/// A drive d is the set of muscles that move one degree of freedom, with shares w_md. e₊ is the
/// pattern of the agonists, whose lines are wound up; e₋ is that of the antagonists, whose lines
/// are paid out. Both are sums of bursts (raised cosines). A reach is parametrised by the scales
/// s_d alone, in V s.
namespace sim::experience {

enum class Role { agonist, antagonist };

/// `<burst of="agonist" at_s="0" for_s="0.3" share="1"/>`. A negative share of an antagonist
/// brakes.
struct Burst {
  static constexpr auto element = "burst", plural = "pattern";
  static constexpr auto description = "Burst of a voltage pattern, a raised cosine.";
  xml::Place place;
  Role of = Role::agonist;
  double at_s = 0, for_s = 0, share = 1;
  void visit(auto& v) {
    v.required("of", of, "Muscles of the burst: agonists wind up, antagonists pay out.");
    v("at_s", at_s, {xml::at_least_zero, "Beginning of the burst."});
    v.required("for_s", for_s, {xml::positive, "Length of the burst."});
    v("share", share,
      "Area of the burst relative to the others; of an antagonist: negative brakes.");
  }
};

/// `<drive name="elbow" shares="0 0 1 -1 …"/>`; shares by actuator, positive if the line is wound
/// up.
struct Drive {
  static constexpr auto element = "drive", plural = "drives";
  static constexpr auto description = "Muscles that move one degree of freedom.";
  xml::Place place;
  std::string name;
  std::vector<double> shares;
  void visit(auto& v) {
    v.required("name", name, "Name of the drive.");
    v.required("shares", shares, "Share of each actuator, positive if its line is wound up.");
  }
};

class Patterns {
 public:
  Patterns() = default;
  /// Throws std::invalid_argument if the bursts of a role are missing or sum up to zero or less.
  explicit Patterns(std::vector<Burst> bursts);

  /// e±, 1/s.
  double at(Role role, double time_s) const;
  /// End of the last burst.
  double end_s() const { return end_s_; }

 private:
  std::vector<Burst> bursts_;
  double sum_[2] = {0, 0}, end_s_ = 0;
};

/// Voltages by muscle, in V. `drives` is muscles × drives.
Eigen::VectorXd voltages_V(const Patterns& patterns, const Eigen::MatrixXd& drives,
                           const Eigen::VectorXd& scales_Vs, double time_s);

/// Muscles × drives. Throws std::invalid_argument if a drive lacks a share for each muscle.
Eigen::MatrixXd matrix_of(const std::vector<Drive>& drives, Eigen::Index muscles);

}  // namespace sim::experience

template <>
struct xml::Names<sim::experience::Role> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::experience::Role>>(
      {{"agonist", sim::experience::Role::agonist},
       {"antagonist", sim::experience::Role::antagonist}});
};
