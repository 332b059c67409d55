// Measures the detection rates of wrong columns in recordings, and counts false alarms.
//   erp_recording_faults ROBOT.XML RECORDING…
// Checks each recording unchanged, then with one column inverted, in another unit, dead, or
// exchanged with another. The index of the recording is the seed of the choice of the column.
// Counts four outcomes: right column, one message; right column, several messages; wrong column; no
// message.
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

void scale(Signal& signal, double factor) {
  for (double& x : signal) x *= factor;
}

/// Injects a fault into a random column; an exchange affects two columns of the same signal.
Fault inject(const std::string& kind, Columns& columns, std::mt19937_64& random) {
  std::erase_if(columns, [](const auto& c) { return c.signal->empty(); });
  const std::size_t column_index = random() % columns.size();
  const auto& [name, unit, signal] = columns[column_index];
  if (kind == "inverted") scale(*signal, -1);
  if (kind == "unit") scale(*signal, unit == "rad" ? 57.29578 : 1000);
  if (kind == "dead") std::ranges::fill(*signal, (*signal)[signal->size() / 2]);
  if (kind != "exchanged") return {kind, {name}};
  const std::string ending = name.substr(name.rfind('.'));
  for (std::size_t k = 1; k < columns.size(); ++k)
    if (auto& other = columns[(column_index + k) % columns.size()];
        other.column.ends_with(ending)) {
      std::swap(*signal, *other.signal);
      return {kind, {name, other.column}};
    }
  return {"", {}};
}

/// The columns that a message reports as wrong, one string per alternative of the message. A
/// message that columns contradict each other reports no column.
std::vector<std::string> reported_columns(const std::string& message) {
  std::vector<std::string> columns;
  std::string remaining_text =
      message.substr(message.find(": ") + 2);  // text after the name of the recording
  while (!remaining_text.empty()) {
    const auto end = remaining_text.find("; or ");
    const std::string alternative = remaining_text.substr(0, end);
    remaining_text = end == remaining_text.npos ? "" : remaining_text.substr(end + 5);
    if (alternative.find("contradict each other") == alternative.npos)
      columns.push_back(
          alternative.substr(0, std::min({alternative.find(" is "), alternative.find(" has "),
                                          alternative.find(" seem ")})));
  }
  return columns;
}

std::string outcome(const std::vector<std::string>& messages, const Fault& fault) {
  if (messages.empty()) return "none";
  const auto reports_fault = [&](const std::string& message) {
    const auto columns = reported_columns(message);
    return std::ranges::any_of(columns, [&](const std::string& subject) {
      return std::ranges::all_of(fault.columns, [&](const std::string& column) {
        return subject.find(column) != subject.npos;
      });
    });
  };
  const bool is_reported = std::ranges::any_of(messages, reports_fault);
  return !is_reported ? "wrong" : messages.size() == 1 ? "one" : "several";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return fmt::print(stderr, "usage: erp_recording_faults ROBOT.XML RECORDING…\n"), 2;
  const erp::Robot robot = as_chains(erp::read_robot(argv[1]));
  std::map<std::string, std::map<std::string, int>> outcome_counts;
  for (int recording_index = 2; recording_index < argc; ++recording_index) {
    std::vector<std::string> remarks;
    const Episode unchanged = lay_out(recording::read_table(argv[recording_index]), robot,
                                      argv[recording_index], remarks);
    const auto false_alarms = sim::checks::column_checks(unchanged, robot);
    for (const auto& message : false_alarms) fmt::print("false alarm: {}\n", message);
    ++outcome_counts["unchanged"][false_alarms.empty() ? "none" : "wrong"];
    std::mt19937_64 random(static_cast<std::uint64_t>(recording_index));
    for (const char* kind : {"inverted", "unit", "dead", "exchanged"}) {
      Episode faulty = unchanged;
      Columns columns = measured(faulty, robot);
      const Fault fault = inject(kind, columns, random);
      if (fault.columns.empty()) continue;
      const auto messages = sim::checks::column_checks(faulty, robot);
      const std::string result = outcome(messages, fault);
      ++outcome_counts[kind][result];
      if (result != "one")
        fmt::print("{} {}: {}: {}\n", kind, fault.columns[0], result,
                   messages.empty() ? argv[recording_index] : messages[0]);
    }
  }
  fmt::print("{:<10}{:>8}{:>8}{:>9}{:>9}\n", "", "one", "several", "wrong", "none");
  for (auto& [kind, counts] : outcome_counts)
    fmt::print("{:<10}{:>8}{:>8}{:>9}{:>9}\n", kind, counts["one"], counts["several"],
               counts["wrong"], counts["none"]);
}
