// Diagnoses a light drive with known friction. The cases differ in sampling period, constant load,
// a disturbance that no law explains, and motion (sums of sines, steady speeds). Prints a table.
// Exits with 1 if a supported answer is wrong.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/gap/diagnosis/diagnose.hpp"
#include "sim/gap/diagnosis/sampling.hpp"
#include "sim/gap/residuals/drives.hpp"
#include "tests/sim/gap/diagnosis/light_drive.hpp"

namespace {

using sim::diagnosis::Diagnosis;
using sim::diagnosis::IdentifiedEffect;

struct Case {
  const char* motion;
  bool is_steady;
  light_drive::Light light;
  light_drive::Rows rows;
};

struct Result {
  Diagnosis diagnosis;
  double reversal_fraction;
};

Result diagnose_case(const Case& c) {
  const auto tables = c.is_steady ? light_drive::at_steady_speeds(c.light, c.rows)
                                  : light_drive::of_sines(c.light, c.rows);
  const erp::Robot robot = sim::residuals::as_chains(light_drive::description());
  std::vector<sim::residuals::Episode> episodes;
  std::vector<std::string> remarks;
  for (const auto& table : tables)
    episodes.push_back(
        sim::residuals::lay_out(table, robot, std::to_string(episodes.size()), remarks));
  const sim::diagnosis::Evaluator evaluator(robot, episodes);
  return {sim::diagnosis::diagnose(robot, episodes), sim::diagnosis::reversal_fraction(evaluator)};
}

/// True value of an effect; 0 if the drive does not have it.
double truth(const std::string& type, const light_drive::Light& light) {
  return type == "gearbox_coulomb"      ? light.coulomb_Nm
         : type == "gearbox_viscous"    ? light.viscous_Nm_s
         : type == "gearbox_asymmetric" ? light.load_Nm
                                        : 0;
}

/// Whether both frictions are identified and the interval of every identified effect contains the
/// true value.
bool is_correct(const Diagnosis& d, const light_drive::Light& light) {
  const auto is_identified = [&](const char* type) {
    return std::ranges::any_of(d.answer, [&](const IdentifiedEffect& n) { return n.type == type; });
  };
  const auto contains_truth = [&](const IdentifiedEffect& n) {
    const double value = truth(n.type, light);
    return value != 0 && n.intervals[0].low <= value && value <= n.intervals[0].high;
  };
  return is_identified("gearbox_coulomb") && is_identified("gearbox_viscous") &&
         std::ranges::all_of(d.answer, contains_truth);
}

std::string values_of(const Diagnosis& d) {
  std::string text;
  for (const IdentifiedEffect& n : d.answer)
    text += fmt::format("{}{} {:.4g} ({:.4g} … {:.4g})", text.empty() ? "" : "; ", n.type,
                        n.values[0], n.intervals[0].low, n.intervals[0].high);
  return text;
}

}  // namespace

int main() {
  std::vector<Case> cases;
  for (const double period_s : {0.002, 0.005, 0.01, 0.02, 0.04})
    for (const double load_Nm : {0.0, 3e-4})
      for (const double disturbance_Nm : {0.0, 3e-4}) {  // 10 % of the friction
        const light_drive::Light light{.load_Nm = load_Nm, .disturbance_Nm = disturbance_Nm};
        cases.push_back({"sines", false, light, {.period_s = period_s}});
        cases.push_back(
            {"six speeds", true, light, {.period_s = period_s, .seconds = 4, .noise_rad = 1e-5}});
      }
  bool all_correct = true;
  fmt::print(
      "| motion | period, ms | load, Nm | disturbance, Nm | rows with reversal, % | verdict | "
      "right | answer |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (const Case& c : cases) {
    const auto [d, reversal_fraction] = diagnose_case(c);
    const bool correct = is_correct(d, c.light);
    const bool supported = d.verdict == sim::diagnosis::Verdict::supported;
    all_correct &= !supported || correct;
    fmt::print("| {} | {:g} | {:g} | {:g} | {:.1f} | {} | {} | {} |\n", c.motion,
               1e3 * c.rows.period_s, c.light.load_Nm, c.light.disturbance_Nm,
               100 * reversal_fraction, sim::diagnosis::word(d.verdict),
               correct     ? "yes"
               : supported ? "NO"
                           : "-",
               values_of(d));
    std::fflush(stdout);
  }
  return all_correct ? 0 : 1;
}
