#include "sim/gap/diagnosis/identifiability.hpp"

#include <fmt/format.h>

#include "sim/gap/diagnosis/sampling.hpp"

namespace sim::diagnosis {

void remove_alternatives_at_bounds(std::vector<IdentifiedEffect>& answer) {
  for (IdentifiedEffect& n : answer)
    std::erase_if(n.alternatives, [](const IdentifiedEffect& other) { return is_at_bound(other); });
}

void require_determined(Diagnosis& d) {
  if (d.verdict != Verdict::supported) return;
  for (const IdentifiedEffect& n : d.answer) {
    const auto reason = undetermined(n);
    if (reason.empty()) continue;
    d.verdict = Verdict::not_identifiable;
    d.warnings.push_back(
        fmt::format("{} on {}: {}; record motions that excite it more", n.type, n.on, reason));
  }
}

void require_sampling(const Evaluator& baseline, Diagnosis& d) {
  if (d.verdict != Verdict::supported && d.verdict != Verdict::none_of_the_known) return;
  const auto reason = rows_too_far_apart(baseline);
  if (!reason) return;
  d.verdict = Verdict::not_identifiable;
  d.warnings.push_back(*reason);
}

void warn_not_evaluated(const Problem& problem, const Detected& detected, Diagnosis& d) {
  d.not_evaluated = not_evaluated(problem.robot, d.stages);
  std::vector<std::string> reasons;
  if (!d.not_evaluated.empty())
    reasons.push_back(fmt::format(
        "{}: not evaluated, because the recordings contain too little of their signals; "
        "record all signals during motion",
        fmt::join(d.not_evaluated, ", ")));
  if (problem.robot.drives.empty() && !detected.bus_evaluated) {
    d.not_evaluated.emplace_back("bus");
    reasons.push_back(
        fmt::format("bus: not evaluated, because no recording shows which set-points the ECUs "
                    "followed; record {}",
                    bus_recording_needs));
  }
  if (!reasons.empty()) d.warnings.push_back(fmt::format("{}", fmt::join(reasons, ". ")));
}

}  // namespace sim::diagnosis
