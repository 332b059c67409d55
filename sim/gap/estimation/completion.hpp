#pragma once
#include "sim/gap/estimation/as_built.hpp"

/// Completes an estimate of a robot as built to an answer.
namespace sim::estimation {

/// The inputs of an answer.
struct Problem {
  const erp::Robot& nominal;
  const Estimator& train;
  const ResidualVector& held_out;
  const AsBuiltOptions& options;
};

/// Whether a constant is never measured when a robot is designed: a zero, or the mass distribution
/// of a body.
bool is_never_certain(const Constant& constant);
/// All constants of the robot except those of withheld effects; `exact`: only those that are never
/// certain.
Uncertain uncertain_of(const erp::Robot& nominal, const std::vector<std::string>& withhold,
                       bool exact);
/// Whether both lists have the same effects at the same places.
bool are_same(const std::vector<effects::Placed>& a, const std::vector<effects::Placed>& b);

/// Sets estimate, indistinguishable effects and open stages of `built` from `found`.
void set_answer(AsBuilt& built, const JudgedEstimate& found);
/// Adds the constants that are far off to an answer, and removes the effects that have become
/// unnecessary. `search` must refer to `built.uncertain`.
JudgedEstimate complete(const Search& search, JudgedEstimate found, const Problem& problem,
                        AsBuilt& built);

/// Searches for an answer with effects and without constants far off. Returns it if it costs less
/// and has no more causes, otherwise `built`. If a single constant and the effect are equivalent,
/// returns the constant.
///
/// `hints`: effects that would explain most if all constants were as described. The search alone
/// does not find an effect that moved constants imitate.
AsBuilt answer_or_effect(const Problem& problem, AsBuilt built,
                         const std::vector<effects::Placed>& hints);

}  // namespace sim::estimation
