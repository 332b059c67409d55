#pragma once

namespace sim::effects {

/// 1/κ_line' = 1/κ_line + c: what lies in series with a tendon's spring.
void soften_line(auto& tendon, double compliance_m_per_N) {
  const auto& line = tendon.line_stiffness_N_per_m;
  const double sum = (line ? 1 / *line : 0) + compliance_m_per_N;
  if (sum > 0) tendon.line_stiffness_N_per_m = 1 / sum;
}

}  // namespace sim::effects
