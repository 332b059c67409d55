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
                       sim::effects::word(gap.stage), gap.on, "not judged", "-", "-", "-",
                       gap.windows);
    return;
  }
  out << fmt::format("{:<8} {:<24} {:>9.3g} {:<3} {:>9.3g} {:>7.1f} {:>7} {:>8}\n",
                     sim::effects::word(gap.stage), gap.on, gap.rms, gap.unit, gap.floor,
                     gap.floor > 0 ? gap.rms / gap.floor : 0, share, gap.windows);
}

/// The bus changes no residual: what the ECUs followed says how late it is.
struct Bus {
  std::vector<diagnosis::Ages> ages;
  bool there, told, late;
  bool explained = false;  ///< late as an effect of the bus has it
  double voltage_late_s;   ///< row_timing.hpp
};

Bus look_at_bus(const erp::Robot& robot, const std::vector<residuals::Episode>& episodes) {
  Bus bus;
  for (const auto& e : episodes) bus.ages.push_back(diagnosis::command_ages(e, robot));
  bus.there = robot.drives.empty(), bus.told = bus.there && diagnosis::told(bus.ages);
  bus.voltage_late_s = episodes.empty() ? 0 : episodes[0].voltage_late_s;
  bus.late = bus.told && diagnosis::late_share(bus.ages) > diagnosis::practical_late;
  const auto fits = diagnosis::fit_bus(bus.ages, bus.ages, robot, {});
  bus.explained = !fits.empty() && fits[0].supported;
  return bus;
}

/// Whether anything could be judged.
bool print_words(const erp::Robot& robot, const std::vector<diagnosis::StageGap>& gaps,
                 const Bus& bus, std::ostream& out) {
  std::string open;
  for (const auto& gap : gaps)
    if (gap.open)
      open += fmt::format("{}{} of {}", open.empty() ? "" : ", ", sim::effects::word(gap.stage),
                          gap.on);
  auto unjudged = diagnosis::not_evaluated(robot, gaps);
  if (bus.there && !bus.told) unjudged.emplace_back("the bus");
  const bool some = std::ranges::any_of(gaps, &diagnosis::StageGap::judged);
  if (!unjudged.empty())
    out << fmt::format("not judged, for lack of signals or of motion: {}\n",
                       fmt::join(unjudged, ", "));
  if (bus.late && !bus.explained)
    out << fmt::format(
        "in {:.0f} % of the ticks with a new command the ECUs followed an older one by their law, "
        "and no effect of the bus explains how old: a wrong tension or shaft column would look the "
        "same\n",
        100 * diagnosis::late_share(bus.ages));
  else if (bus.late)
    out << fmt::format(
        "the bus is late: in {:.0f} % of the ticks with a new command the ECUs followed "
        "an older one, {:.3g} ms old in the mean\n",
        100 * diagnosis::late_share(bus.ages), 1e3 * diagnosis::mean_age_s(bus.ages));
  if (const double late_s = bus.voltage_late_s; late_s > 0)
    out << fmt::format(
        "the bus is late: voltages act {:.3g} ms after their rows, or all sensors lag by that "
        "time\n",
        1e3 * late_s);
  if (!open.empty()) out << "the gap is in: " << open << "\n";
  else if (!some) out << nothing_judged;
  else if (bus.late) out << "no gap elsewhere: the residuals of what was judged are noise\n";
  else if (unjudged.empty()) out << "no gap: the residuals of every stage are noise\n";
  else out << "no gap in the others: their residuals are noise\n";
  return some;
}

}  // namespace

int where(const std::string& robot_file, const std::vector<std::string>& recordings,
          std::ostream& out, std::ostream& remarks) {
  const erp::Robot robot = read_chains(robot_file);
  const Reading read = read_episodes(robot, recordings);
  tell(read.mended, remarks), print_suspicious(read, remarks);
  const auto gaps = diagnosis::localize(robot, read.episodes);
  out << fmt::format("{:<8} {:<24} {:>13} {:>9} {:>7} {:>7} {:>8}\n", "stage", "on", "residual",
                     "floor", "times", "share", "windows");
  for (const auto& gap : gaps) print_row(gap, out);
  return print_words(robot, gaps, look_at_bus(robot, read.episodes), out) ? 0 : 5;
}

}  // namespace launch::gap
