#include "launch/erp/gap.hpp"

#include <fmt/format.h>

#include <ostream>

#include "sim/diagnosis/where.hpp"
#include "sim/residuals/common_signals.hpp"
#include "sim/residuals/drives.hpp"
#include "sim/residuals/units.hpp"

namespace launch {
namespace {

namespace diagnosis = sim::diagnosis;
namespace residuals = sim::residuals;

void print_row(const diagnosis::StageGap& gap, std::ostream& out) {
  const std::string share = gap.open ? fmt::format("{:.0f} %", 100 * gap.share) : "-";
  out << fmt::format("{:<8} {:<24} {:>9.3g} {:<3} {:>9.3g} {:>7.1f} {:>7} {:>8}\n",
                     sim::effects::word(gap.stage), gap.on, gap.rms, gap.unit, gap.floor,
                     gap.floor > 0 ? gap.rms / gap.floor : 0, share, gap.windows);
}

/// The stages for which `holds`, in words.
std::string named(const std::vector<diagnosis::StageGap>& gaps, bool diagnosis::StageGap::*holds,
                  bool wanted) {
  std::string names;
  for (const auto& gap : gaps)
    if (gap.*holds == wanted)
      names += fmt::format("{}{} of {}", names.empty() ? "" : ", ", sim::effects::word(gap.stage),
                           gap.on);
  return names;
}

void print_words(const std::vector<diagnosis::StageGap>& gaps, std::ostream& out) {
  const std::string open = named(gaps, &diagnosis::StageGap::open, true);
  const std::string unjudged = named(gaps, &diagnosis::StageGap::judged, false);
  if (!unjudged.empty())
    out << "not judged, for want of windows in which they move: " << unjudged << "\n";
  if (!open.empty()) out << "the gap is in: " << open << "\n";
  else if (unjudged.empty()) out << "no gap: every stage is left with the noise of its sensors\n";
  else out << "no gap in the others: they are left with the noise of their sensors\n";
}

}  // namespace

erp::Robot read_chains(const std::string& robot_file) {
  return residuals::as_chains(erp::read_robot(robot_file));
}

std::vector<residuals::Episode> read_episodes(const erp::Robot& robot,
                                              const std::vector<std::string>& recordings,
                                              std::vector<std::string>& mended) {
  std::vector<residuals::Episode> episodes;
  for (const std::string& file : recordings) {
    episodes.push_back(
        residuals::lay_out(recording::read_table(file, {.robot = robot.name, .sequences = true}),
                           robot, file, mended));
    for (std::string& odd : residuals::odd_units(episodes.back(), robot))
      mended.push_back(std::move(odd));
  }
  residuals::keep_common(episodes, robot, mended);
  return episodes;
}

int gap_where(const std::string& robot_file, const std::vector<std::string>& recordings,
              std::ostream& out, std::ostream& remarks) {
  const erp::Robot robot = read_chains(robot_file);
  std::vector<std::string> mended;
  const auto gaps = diagnosis::where(robot, read_episodes(robot, recordings, mended));
  for (const std::string& remark : mended) remarks << remark << "\n";
  out << fmt::format("{:<8} {:<24} {:>13} {:>9} {:>7} {:>7} {:>8}\n", "stage", "on", "residual",
                     "floor", "times", "share", "windows");
  for (const auto& gap : gaps) print_row(gap, out);
  print_words(gaps, out);
  return 0;
}

}  // namespace launch
