#pragma once

namespace sim::effects {

/// What gives lies in series with a tendon's spring and damper,  F = κ x + d ẋ,  Δx = x + c F.
/// For motions that are slow against 1/(c d):
///
///   1/κ_line' = 1/κ_line + c      d' = d/(1 + κ c)²      κ: of spring and line so far
///
/// Ignores that a spring which stiffens has another κ at each stretch.
void soften_line(auto& tendon, double compliance_m_per_N) {
  auto& line = tendon.line_stiffness_N_per_m;
  const double gave = line ? 1 / *line : 0, gives = gave + compliance_m_per_N;
  if (!(gives > 0)) return;
  line = 1 / gives;
  const double softer = 1 + compliance_m_per_N / (1 / tendon.stiffness_N_per_m + gave);
  tendon.damping_N_s_per_m /= softer * softer;
}

}  // namespace sim::effects
