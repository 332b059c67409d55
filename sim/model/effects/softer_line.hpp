#pragma once

namespace sim::effects {

/// A compliance c in series with a tendon's spring and damper,  F = κ x + d ẋ,  Δx = x + c F.
/// For motions slower than 1/(c d):
///
///   1/κ_line' = 1/κ_line + c,   d' = d/(1 + κ c)²
///
/// κ: stiffness of spring and line in series, before the change.
///
/// Ignores that κ of a stiffening spring depends on the stretch.
void soften_line(auto& tendon, double compliance_m_per_N) {
  auto& line = tendon.line_stiffness_N_per_m;
  const double before_m_per_N = line ? 1 / *line : 0,
               after_m_per_N = before_m_per_N + compliance_m_per_N;
  if (!(after_m_per_N > 0)) return;
  line = 1 / after_m_per_N;
  const double ratio = 1 + compliance_m_per_N / (1 / tendon.stiffness_N_per_m + before_m_per_N);
  tendon.damping_N_s_per_m /= ratio * ratio;
}

}  // namespace sim::effects
