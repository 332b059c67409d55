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

/// Simulated recordings of the robot, one per kind of excitation.
std::vector<residuals::Episode> simulated(const erp::Robot& robot, double seconds) {
  std::vector<residuals::Episode> episodes;
  std::vector<std::string> remarks;
  for (int kind = 0; kind < sim::excitation_kinds; ++kind) {
    const auto set_points =
        sim::closed_loop::set_points_of(sim::excitation(robot, kind, seconds, 1));
    episodes.push_back(residuals::lay_out(sim::closed_loop::predict_run(robot, set_points), robot,
                                          sim::excitation_name(robot, kind), remarks));
  }
  return episodes;
}

void remove_signals(const std::vector<std::string>& signals,
                    std::vector<residuals::Episode>& episodes) {
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

std::vector<diagnosis::Indistinguishable> search(const diagnosis::Evaluator& evaluator,
                                                 const IndistinguishableOptions& options) {
  if (options.max_effects < 2)
    return diagnosis::indistinguishable_effects(evaluator, options.share, options.withhold,
                                                options.threads);
  return diagnosis::confounders(evaluator, {.share = options.share,
                                            .most = std::size_t(options.max_effects),
                                            .withhold = options.withhold,
                                            .threads = options.threads});
}

std::string names_of(const std::vector<Placed>& others) {
  std::string names;
  for (const Placed& other : others) names += (names.empty() ? "" : " + ") + name_of(other);
  return names;
}

}  // namespace

int list_indistinguishable(const IndistinguishableOptions& options, std::ostream& out,
                           std::ostream& remarks) {
  check_withheld(options.withhold);
  const erp::Robot robot = read_chains(options.robot);
  if (options.recordings.empty() && !robot.drives.empty())
    throw std::invalid_argument(
        options.robot + ": the simulator does not support drives; give recordings with --real");
  const Reading read = read_episodes(robot, options.recordings);
  print_lines(read.corrections, remarks), print_suspicious(read, remarks);
  auto episodes = options.recordings.empty() ? simulated(robot, options.seconds) : read.episodes;
  remove_signals(options.without, episodes);
  if (!can_evaluate(episodes)) {
    out << nothing_evaluated;
    return 5;
  }
  const diagnosis::Evaluator evaluator(robot, std::move(episodes));
  std::vector<std::vector<std::string>> rows{
      {"hidden effect", "size", "replaced by", "visible, sigma", "remaining, sigma", "similarity"}};
  for (const auto& pair : search(evaluator, options))
    rows.push_back(
        {name_of(pair.hidden), size_of(pair.hidden), names_of(pair.others),
         fmt::format("{:.1f}", pair.magnitude), fmt::format("{:.2g}", pair.remaining),
         fmt::format("{:.4f}", std::sqrt(1 - std::pow(pair.remaining / pair.magnitude, 2)))});
  for (const std::string& line : align(rows, {false, false, false, true, true, true}))
    out << line << "\n";
  if (rows.size() == 1) out << "the sensors distinguish every visible effect from every other\n";
  else
    out << "visible: change of all residuals by the hidden effect, in standard deviations of their "
           "noise;\nremaining: part of that change that the replacement does not explain; "
           "similarity: 1 if nothing remains\n";
  return 0;
}

}  // namespace launch::gap
