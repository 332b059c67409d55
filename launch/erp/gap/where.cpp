#include "launch/erp/gap/gap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "sim/gap/diagnosis/bus.hpp"
#include "sim/gap/diagnosis/localization.hpp"

namespace launch::gap {
namespace {

namespace diagnosis = sim::diagnosis;
namespace residuals = sim::residuals;

void print_row(const diagnosis::StageGap& gap, std::ostream& out) {
  const std::string share = !gap.open           ? "-"
                            : gap.share < 0.005 ? "<1 %"
                                                : fmt::format("{:.0f} %", 100 * gap.share);
  if (!gap.judged) {
    out << fmt::format("{:<8} {:<24} {:>13} {:>9} {:>7} {:>7} {:>8}\n",
                       sim::effects::word(gap.stage), gap.on, "not evaluated", "-", "-", "-",
                       gap.windows);
    return;
  }
  out << fmt::format("{:<8} {:<24} {:>9.3g} {:<3} {:>9.3g} {:>7.1f} {:>7} {:>8}\n",
                     sim::effects::word(gap.stage), gap.on, gap.rms, gap.unit, gap.floor,
                     gap.floor > 0 ? gap.rms / gap.floor : 0, share, gap.windows);
}

/// Delay of the bus. It changes no residual, but the ages of the commands that the ECUs executed.
struct Bus {
  std::vector<diagnosis::Ages> ages;
  bool has_bus, is_evaluated, is_delayed;
  bool is_explained = false;  ///< an effect of the bus explains the ages
  double voltage_delay_s;     ///< see row_timing.hpp
};

Bus evaluate_bus(const erp::Robot& robot, const std::vector<residuals::Episode>& episodes) {
  Bus bus;
  for (const auto& e : episodes) bus.ages.push_back(diagnosis::command_ages(e, robot));
  bus.has_bus = robot.drives.empty(),
  bus.is_evaluated = bus.has_bus && diagnosis::has_enough_ages(bus.ages);
  bus.voltage_delay_s = episodes.empty() ? 0 : episodes[0].voltage_delay_s;
  bus.is_delayed = bus.is_evaluated &&
                   diagnosis::delayed_fraction(bus.ages) > diagnosis::negligible_delayed_fraction;
  const auto fits = diagnosis::fit_bus(bus.ages, bus.ages, robot, {});
  bus.is_explained = !fits.empty() && fits[0].supported;
  return bus;
}

/// Returns whether any stage could be evaluated.
bool print_summary(const erp::Robot& robot, const std::vector<diagnosis::StageGap>& gaps,
                   const Bus& bus, std::ostream& out) {
  std::string open_stages;
  for (const auto& gap : gaps)
    if (gap.open)
      open_stages += fmt::format("{}{} of {}", open_stages.empty() ? "" : ", ",
                                 sim::effects::word(gap.stage), gap.on);
  auto not_evaluated = diagnosis::not_evaluated(robot, gaps);
  if (bus.has_bus && !bus.is_evaluated) not_evaluated.emplace_back("the bus");
  const bool has_evaluated_stage = std::ranges::any_of(gaps, &diagnosis::StageGap::judged);
  if (!not_evaluated.empty())
    out << fmt::format("not evaluated, because signals or motion are missing: {}\n",
                       fmt::join(not_evaluated, ", "));
  if (bus.is_delayed && !bus.is_explained)
    out << fmt::format(
        "in {:.0f} % of the ticks with a new command the ECUs appear to have executed an older "
        "command, but no effect of the bus explains the ages; check the tension and shaft columns, "
        "whose errors look the same\n",
        100 * diagnosis::delayed_fraction(bus.ages));
  else if (bus.is_delayed)
    out << fmt::format(
        "the bus is late: in {:.0f} % of the ticks with a new command the ECUs executed an older "
        "command, {:.3g} ms old on average\n",
        100 * diagnosis::delayed_fraction(bus.ages), 1e3 * diagnosis::mean_age_s(bus.ages));
  if (const double delay_s = bus.voltage_delay_s; delay_s > 0)
    out << fmt::format(
        "the bus is late: voltages act {:.3g} ms after their rows, or all sensors lag by that "
        "time\n",
        1e3 * delay_s);
  if (!open_stages.empty()) out << "the gap is in: " << open_stages << "\n";
  else if (!has_evaluated_stage) out << nothing_evaluated;
  else if (bus.is_delayed)
    out << "no gap elsewhere: the residuals of all evaluated stages are within their noise\n";
  else if (not_evaluated.empty())
    out << "no gap: the residuals of all stages are within their noise\n";
  else out << "no gap in the other stages: their residuals are within their noise\n";
  return has_evaluated_stage;
}

}  // namespace

int where(const std::string& robot_file, const std::vector<std::string>& recordings,
          std::ostream& out, std::ostream& remarks) {
  const erp::Robot robot = read_chains(robot_file);
  const Reading read = read_episodes(robot, recordings);
  print_lines(read.corrections, remarks), print_suspicious(read, remarks);
  const auto gaps = diagnosis::localize(robot, read.episodes);
  out << fmt::format("{:<8} {:<24} {:>13} {:>9} {:>7} {:>7} {:>8}\n", "stage", "on", "residual",
                     "noise", "ratio", "share", "windows");
  for (const auto& gap : gaps) print_row(gap, out);
  return print_summary(robot, gaps, evaluate_bus(robot, read.episodes), out) ? 0 : 5;
}

}  // namespace launch::gap
