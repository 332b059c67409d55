#include "launch/erp/gap/free_run_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace launch::gap {
namespace {

namespace diagnosis = sim::diagnosis;
namespace residuals = sim::residuals;
namespace closed_loop = sim::closed_loop;
using diagnosis::IdentifiedEffect;

/// The held-out recordings. A recording for both training and validation is reduced to its
/// validation part.
std::vector<residuals::Episode> held_out_of(const diagnosis::Diagnosis& d,
                                            const std::vector<residuals::Episode>& episodes) {
  std::vector<residuals::Episode> held_out;
  for (const auto& e : episodes)
    if (std::ranges::count(d.held_out, e.name)) held_out.push_back(e);
  for (const auto& [recording, judged_from_s] : d.split_recordings)
    if (const auto e = std::ranges::find(held_out, recording, &residuals::Episode::name);
        e != held_out.end())
      e->judge_from(judged_from_s);
  return held_out;
}

/// Exchanges the answer and its equivalent effect `k`.
void swap_with_alternative(IdentifiedEffect& answer, std::size_t k) {
  IdentifiedEffect other = answer.alternatives[k];
  other.supported = answer.supported, other.alternatives = answer.alternatives;
  other.alternatives.erase(other.alternatives.begin() + std::ptrdiff_t(k));
  answer.alternatives.clear();
  other.alternatives.insert(other.alternatives.begin(), answer);
  answer = std::move(other);
}

/// Free runs of the robot with different effects on the held-out recordings.
class FreeRuns {
 public:
  FreeRuns(const diagnosis::Diagnosis& d, const std::vector<residuals::Episode>& episodes,
           const erp::Robot& robot, const DiagnoseOptions& options,
           const std::function<void(double)>& progress)
      : robot_(robot),
        options_{options.threads, options.seed, progress},
        held_out_(held_out_of(d, episodes)) {}

  closed_loop::FreeRun of(const std::vector<IdentifiedEffect>& answer) const {
    erp::Robot corrected = robot_;
    for (const IdentifiedEffect& effect : answer)
      corrected.effects.push_back(sim::effects::written(effect.placed));
    return of(corrected);
  }
  closed_loop::FreeRun of(const erp::Robot& corrected) const {
    return closed_loop::free_run(robot_, corrected, held_out_, options_);
  }

 private:
  const erp::Robot& robot_;
  closed_loop::FreeRunOptions options_;
  std::vector<residuals::Episode> held_out_;
};

}  // namespace

closed_loop::FreeRun free_run_of(diagnosis::Diagnosis& d,
                                 const std::vector<residuals::Episode>& episodes,
                                 const erp::Robot& robot, const DiagnoseOptions& options,
                                 const std::function<void(double)>& progress) {
  constexpr double gap_limit = 2;              // times the noise; chosen
  constexpr double improvement = 0.5;          // of the error; chosen
  constexpr std::size_t max_alternatives = 4;  // equivalent effects that are simulated; chosen
  const bool has_no_answer =
      d.answer.empty() && !d.as_built && d.verdict != diagnosis::Verdict::no_gap;
  if (has_no_answer || !options.free_run || !robot.drives.empty()) return {};
  const FreeRuns runs(d, episodes, robot, options, progress);
  if (d.as_built) return runs.of(*d.as_built);
  closed_loop::FreeRun best_run = runs.of(d.answer);
  if (d.verdict != diagnosis::Verdict::supported || d.answer.size() != 1 ||
      !(best_run.all.after > gap_limit * best_run.all.floor))
    return best_run;
  IdentifiedEffect& answer = d.answer[0];
  std::size_t best_alternative = answer.alternatives.size();
  const double first_error = best_run.all.after;
  for (std::size_t k = 0; k < std::min(max_alternatives, answer.alternatives.size()); ++k)
    if (auto run = runs.of({answer.alternatives[k]});
        run.all.after < improvement * best_run.all.after)
      best_run = std::move(run), best_alternative = k;
  if (best_alternative == answer.alternatives.size()) return best_run;
  d.warnings.push_back(fmt::format(
      "the residuals do not distinguish {} on {} from {} on {}; the free-run error is {:.3g} times "
      "the noise with the former and {:.3g} times with the latter, which is listed first",
      answer.type, answer.on, answer.alternatives[best_alternative].type,
      answer.alternatives[best_alternative].on, first_error, best_run.all.after));
  swap_with_alternative(answer, best_alternative);
  return best_run;
}

}  // namespace launch::gap
