// Detection rates of wrong columns in recordings, and false alarms.
//   erp_recording_faults ROBOT.XML RECORDING…
// Checks each recording unchanged, then with one column inverted, in another unit, dead, or exchanged with another; the
// index of the recording seeds the choice of the column. Counts: right column, one message; right column, several
// messages; wrong column; no message.
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

/// Injects a fault into a random column; an exchange affects two columns of the same signal.
Fault inject(const std::string& kind, Columns& columns, std::mt19937_64& random) {
  std::erase_if(columns, [](const auto& c) { return c.signal->empty(); });
  const std::size_t n = random() % columns.size();
  const auto& [name, unit, signal] = columns[n];
  if (kind == "inverted") scale(*signal, -1);
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

/// The columns that a message reports as wrong, one string per alternative of the message. A message that columns
/// contradict each other reports no column.
std::vector<std::string> reported_columns(const std::string& message) {
  std::vector<std::string> all;
  std::string rest =
      message.substr(message.find(": ") + 2);  // text after the name of the recording
  while (!rest.empty()) {
    const auto end = rest.find("; or ");
    const std::string one = rest.substr(0, end);
    rest = end == rest.npos ? "" : rest.substr(end + 5);
    if (one.find("contradict each other") == one.npos)
      all.push_back(
          one.substr(0, std::min({one.find(" is "), one.find(" has "), one.find(" seem ")})));
  }
  return all;
}

std::string outcome(const std::vector<std::string>& messages, const Fault& fault) {
  if (messages.empty()) return "none";
  const auto is_right = [&](const std::string& message) {
    const auto all = reported_columns(message);
    return std::ranges::any_of(all, [&](const std::string& subject) {
      return std::ranges::all_of(fault.columns, [&](const std::string& column) {
        return subject.find(column) != subject.npos;
      });
    });
  };
  const bool right = std::ranges::any_of(messages, is_right);
  return !right ? "wrong" : messages.size() == 1 ? "one" : "several";
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
    for (const auto& message : false_alarms) fmt::print("false alarm: {}\n", message);
    ++count["unchanged"][false_alarms.empty() ? "none" : "wrong"];
    std::mt19937_64 random(static_cast<std::uint64_t>(n));
    for (const char* kind : {"inverted", "unit", "dead", "exchanged"}) {
      Episode faulty = plain;
      Columns columns = measured(faulty, robot);
      const Fault fault = inject(kind, columns, random);
      if (fault.columns.empty()) continue;
      const auto messages = sim::checks::column_checks(faulty, robot);
      const std::string what = outcome(messages, fault);
      ++count[kind][what];
      if (what != "one")
        fmt::print("{} {}: {}: {}\n", kind, fault.columns[0], what,
                   messages.empty() ? argv[n] : messages[0]);
    }
  }
  fmt::print("{:<10}{:>8}{:>8}{:>9}{:>9}\n", "", "one", "several", "wrong", "none");
  for (auto& [kind, of] : count)
    fmt::print("{:<10}{:>8}{:>8}{:>9}{:>9}\n", kind, of["one"], of["several"], of["wrong"],
               of["none"]);
}
