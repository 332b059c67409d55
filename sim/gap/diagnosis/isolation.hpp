#pragma once
#include "sim/gap/diagnosis/problem.hpp"

/// Isolation: the parts of the robot that can cause the gap, whatever its law, by the fault-signature
/// matrix.
///
///   s_r = mean Δz² at stage r         Δz: change there by a small effect
///
/// A signature, scaled to the excess of the stage with the largest share, must open every open stage and
/// no closed one. A part is reported if one of its effects does so. Withheld types are left out. Ignores
/// the course of the gap in time, and gaps with several causes.
namespace sim::diagnosis {

/// A part of the robot, from bus to sensors.
struct Part {
  effects::Stage stage;
  std::string on;
};

/// Parts that can cause the gap of the nominal robot in the training recording with the largest
/// residuals, in the order of the library. Empty if no single part can.
std::vector<Part> isolate(const Problem& problem, const Evaluator& evaluator);

}  // namespace sim::diagnosis
