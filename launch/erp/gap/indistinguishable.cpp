#include <fmt/format.h>

#include <cmath>
#include <ostream>
#include <stdexcept>

#include "launch/erp/gap/gap.hpp"
#include "launch/erp/text/columns.hpp"
#include "sim/gap/closed_loop/predicted_run.hpp"
#include "sim/gap/diagnosis/confounders.hpp"

namespace launch::gap {
namespace {

namespace diagnosis = sim::diagnosis;
namespace residuals = sim::residuals;
using sim::effects::name_of;
using sim::effects::Placed;

/// What the simulator would record of the robot, one a kind of excitation.
std::vector<residuals::Episode> rehearsed(const erp::Robot& robot, double seconds) {
  std::vector<residuals::Episode> episodes;
  std::vector<std::string> remarks;
  for (int kind = 0; kind < sim::excitation_kinds; ++kind) {
    const auto score = sim::closed_loop::set_points_of(sim::excitation(robot, kind, seconds, 1));
    episodes.push_back(residuals::lay_out(sim::closed_loop::predict_run(robot, score), robot,
                                          sim::excitation_word(robot, kind), remarks));
  }
  return episodes;
}

void leave_out(const std::vector<std::string>& signals, std::vector<residuals::Episode>& episodes) {
  for (const std::string& signal : signals)
    for (residuals::Episode& e : episodes) {
      for (residuals::ActuatorSignals& a : e.actuators) {
        if (signal == "tension") a.tension_N.clear();
        if (signal == "current") a.current_A.clear();
      }
      for (residuals::JointSignals& j : e.joints)
        if (signal == "joint") j = {};
    }
}

std::string size_of(Placed p) {
  const auto first = sim::effects::parameters(p.effect)[0];
  return fmt::format("{} = {:.2g}", first.name, *first.value);
}

std::vector<diagnosis::Indistinguishable> found(const diagnosis::Evaluator& evaluator,
                                                const IndistinguishableOptions& options) {
  if (options.together < 2)
    return diagnosis::indistinguishable_effects(evaluator, options.share, options.withhold,
                                                options.threads);
  return diagnosis::confounders(evaluator, {.share = options.share,
                                            .most = std::size_t(options.together),
                                            .withhold = options.withhold,
                                            .threads = options.threads});
}

std::string names_of(const std::vector<Placed>& others) {
  std::string names;
  for (const Placed& other : others) names += (names.empty() ? "" : " + ") + name_of(other);
  return names;
}

}  // namespace

int twins(const IndistinguishableOptions& options, std::ostream& out, std::ostream& remarks) {
  check_withheld(options.withhold);
  const erp::Robot robot = read_chains(options.robot);
  if (options.recordings.empty() && !robot.drives.empty())
    throw std::invalid_argument(options.robot +
                                ": the simulator does not run drives; give recordings with --real");
  const Reading read = read_episodes(robot, options.recordings);
  tell(read.mended, remarks), print_suspicious(read, remarks);
  auto episodes = options.recordings.empty() ? rehearsed(robot, options.seconds) : read.episodes;
  leave_out(options.without, episodes);
  if (!can_judge(episodes)) {
    out << nothing_judged;
    return 5;
  }
  const diagnosis::Evaluator evaluator(robot, std::move(episodes));
  std::vector<std::vector<std::string>> rows{
      {"hidden", "as small as", "would pass for", "shows, sigma", "left, sigma", "likeness"}};
  for (const auto& twin : found(evaluator, options))
    rows.push_back({name_of(twin.hidden), size_of(twin.hidden), names_of(twin.others),
                    fmt::format("{:.1f}", twin.shows), fmt::format("{:.2g}", twin.left),
                    fmt::format("{:.4f}", std::sqrt(1 - std::pow(twin.left / twin.shows, 2)))});
  for (const std::string& line : align(rows, {false, false, false, true, true, true}))
    out << line << "\n";
  if (rows.size() == 1) out << "every effect that shows can be told from every other\n";
  else
    out << "shows: what a hidden effect of that size changes in all residuals together, in "
           "standard "
           "deviations of their\nnoise; left: of it, once the other stands for it; likeness: 1 "
           "where "
           "nothing is left\n";
  return 0;
}

}  // namespace launch::gap
