#pragma once
#include "sim/gap/diagnosis/problem.hpp"

/// Which parts of the chain could leave such a gap, whatever law it follows there: the
/// fault-signature matrix, and what it can isolate with the sensors that there are.
///
///   s_r = mean Δz² at stage r         Δz what a nudge of an effect changes there
///
/// A nudge grown until it fills the widest stage of the gap must open every stage that is open and
/// none that is closed; a part of the chain is suspected if some effect that belongs to it does so.
/// What is withheld is not known here either. Ignores: how a gap runs in time, and gaps of several
/// causes.
namespace sim::diagnosis {

/// A part of the chain, bus to sensors.
struct Part {
  effects::Stage stage;
  std::string on;
};

/// Those that could leave the gap of the nominal robot, on the training recording where it is
/// largest; in the order of the library. Empty: no single part could.
std::vector<Part> isolate(const Problem& problem, const Evaluator& evaluator);

}  // namespace sim::diagnosis
