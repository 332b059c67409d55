#pragma once
#include "sim/gap/diagnosis/problem.hpp"

/// Isolation: the parts of the robot that can cause the gap, independent of its law, by the
/// fault-signature matrix.
///
///   s_r = mean Δz² at stage r         Δz: change of the residuals there by a small effect
///
/// A signature is scaled to the excess of the stage with the largest share. It explains the gap if
/// it opens every open stage and no other stage. A part is reported if one of its effects explains
/// the gap. Withheld types are omitted. Ignores the course of the gap in time, and gaps with
/// several causes.
namespace sim::diagnosis {

/// A part of the robot, from bus to sensors.
struct Part {
  effects::Stage stage;
  std::string on;
};

/// Returns the parts that can cause the gap of the nominal robot in the training recording with the
/// largest residuals, in the order of the library. Empty if no single part can cause it.
std::vector<Part> isolate(const Problem& problem, const Evaluator& evaluator);

}  // namespace sim::diagnosis
