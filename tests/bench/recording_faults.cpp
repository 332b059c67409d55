// How often a fault of a recording is told, and how often one is told that is not there.
//   erp_recording_faults ROBOT.XML RECORDING…
// Each recording is asked as it is, then with one column turned, in another unit, dead, or exchanged with
// another, drawn from its number. Of a fault: its column blamed alone; told beside another sentence; another
// column blamed; nothing said.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <random>

#include "sim/gap/checks/column_checks.hpp"
#include "sim/gap/residuals/drives.hpp"
#include "sim/gap/residuals/measured.hpp"

namespace {

using namespace sim::residuals;
using Columns = std::vector<Measured<Episode>>;

struct Fault {
  std::string kind;
  std::vector<std::string> columns;
};

void scale(Signal& signal, double by) {
  for (double& x : signal) x *= by;
}

/// Injects it; of an exchange, two columns of one kind.
Fault inject(const std::string& kind, Columns& columns, std::mt19937_64& random) {
  std::erase_if(columns, [](const auto& c) { return c.signal->empty(); });
  const std::size_t n = random() % columns.size();
  const auto& [name, unit, signal] = columns[n];
  if (kind == "turned") scale(*signal, -1);
  if (kind == "unit") scale(*signal, unit == "rad" ? 57.29578 : 1000);
  if (kind == "dead") std::ranges::fill(*signal, (*signal)[signal->size() / 2]);
  if (kind != "exchanged") return {kind, {name}};
  const std::string ending = name.substr(name.rfind('.'));
  for (std::size_t k = 1; k < columns.size(); ++k)
    if (auto& other = columns[(n + k) % columns.size()]; other.column.ends_with(ending)) {
      std::swap(*signal, *other.signal);
      return {kind, {name, other.column}};
    }
  return {"", {}};
}

/// Of each alternative of a sentence its subject: the columns that it says are wrong, not those that
/// it tells it by. That columns contradict each other blames none.
std::vector<std::string> blamed(const std::string& sentence) {
  std::vector<std::string> all;
  std::string rest = sentence.substr(sentence.find(": ") + 2);  // behind the recording's name
  while (!rest.empty()) {
    const auto end = rest.find("; or ");
    const std::string one = rest.substr(0, end);
    rest = end == rest.npos ? "" : rest.substr(end + 5);
    if (one.find("contradict each other") == one.npos)
      all.push_back(one.substr(0, std::min(one.find(": "), one.find(" is "))));
  }
  return all;
}

std::string outcome(const std::vector<std::string>& odd, const Fault& fault) {
  if (odd.empty()) return "nothing";
  const auto tells = [&](const std::string& sentence) {
    const auto all = blamed(sentence);
    return std::ranges::any_of(all, [&](const std::string& subject) {
      return std::ranges::all_of(fault.columns, [&](const std::string& column) {
        return subject.find(column) != subject.npos;
      });
    });
  };
  const bool told = std::ranges::any_of(odd, tells);
  return !told ? "another" : odd.size() == 1 ? "alone" : "beside";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return fmt::print(stderr, "usage: erp_recording_faults ROBOT.XML RECORDING…\n"), 2;
  const erp::Robot robot = as_chains(erp::read_robot(argv[1]));
  std::map<std::string, std::map<std::string, int>> count;
  for (int n = 2; n < argc; ++n) {
    std::vector<std::string> remarks;
    const Episode plain = lay_out(recording::read_table(argv[n]), robot, argv[n], remarks);
    const auto false_alarms = sim::checks::column_checks(plain, robot);
    for (const auto& sentence : false_alarms) fmt::print("falsely: {}\n", sentence);
    ++count["as it is"][false_alarms.empty() ? "nothing" : "another"];
    std::mt19937_64 random(static_cast<std::uint64_t>(n));
    for (const char* kind : {"turned", "unit", "dead", "exchanged"}) {
      Episode faulty = plain;
      Columns columns = measured(faulty, robot);
      const Fault fault = inject(kind, columns, random);
      if (fault.columns.empty()) continue;
      const auto odd = sim::checks::column_checks(faulty, robot);
      const std::string what = outcome(odd, fault);
      ++count[kind][what];
      if (what != "alone")
        fmt::print("{} {}: {}: {}\n", kind, fault.columns[0], what, odd.empty() ? argv[n] : odd[0]);
    }
  }
  fmt::print("{:<10}{:>8}{:>8}{:>9}{:>9}\n", "", "alone", "beside", "another", "nothing");
  for (auto& [kind, of] : count)
    fmt::print("{:<10}{:>8}{:>8}{:>9}{:>9}\n", kind, of["alone"], of["beside"], of["another"],
               of["nothing"]);
}
