#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "interfaces/xml/plural.hpp"

/// Voltage patterns after electromyograms of fast reaches, shared among muscles and scaled.
///
///   V_m(t) = Σ_d s_d w_md e±(t),   ∫ e± dt = 1
///
/// A drive d is a set of muscles that are wound up and let out together, in shares w_md: one of each
/// degree of freedom. e₊ is the pattern of muscles that are wound up, the agonists, e₋ of those that
/// are let out. Both are sums of bursts, raised cosines. s_d, V s, is all that is chosen for a reach.
namespace sim::experience {

enum class Role { agonist, antagonist };

/// `<burst of="agonist" at_s="0" for_s="0.3" share="1"/>`; of an antagonist a negative share brakes.
struct Burst {
  static constexpr auto element = "burst", plural = "pattern";
  xml::Place place;
  Role of = Role::agonist;
  double at_s = 0, for_s = 0, share = 1;
  void visit(auto& v) {
    v.required("of", of);
    v("at_s", at_s, xml::at_least_zero);
    v.required("for_s", for_s, xml::positive);
    v("share", share);
  }
};

/// `<drive name="elbow" shares="0 0 1 -1 …"/>`: by actuator; positive where the muscle is wound up.
struct Drive {
  static constexpr auto element = "drive", plural = "drives";
  xml::Place place;
  std::string name;
  std::vector<double> shares;
  void visit(auto& v) { v.required("name", name), v.required("shares", shares); }
};

class Patterns {
 public:
  Patterns() = default;
  /// Throws std::invalid_argument: bursts of a role that sum up to nothing, or none.
  explicit Patterns(std::vector<Burst> bursts);

  /// e±, 1/s.
  double at(Role role, double time_s) const;
  /// When the last burst has ended.
  double end_s() const { return end_s_; }

 private:
  std::vector<Burst> bursts_;
  double sum_[2] = {0, 0}, end_s_ = 0;
};

/// V by muscle, of drives (muscles × drives) scaled so.
Eigen::VectorXd voltages_V(const Patterns& patterns, const Eigen::MatrixXd& drives,
                           const Eigen::VectorXd& scales_Vs, double time_s);

/// Muscles × drives. Throws std::invalid_argument: a drive that has not a share for each muscle.
Eigen::MatrixXd matrix_of(const std::vector<Drive>& drives, Eigen::Index muscles);

}  // namespace sim::experience

template <>
struct xml::Names<sim::experience::Role> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::experience::Role>>(
      {{"agonist", sim::experience::Role::agonist},
       {"antagonist", sim::experience::Role::antagonist}});
};
