#include <cmath>
#include <ostream>

#include "interfaces/recording/csv.hpp"
#include "launch/erp/learn/calibrate.hpp"

namespace launch {
namespace {

using References = std::vector<double>;  ///< by column

std::vector<std::size_t> columns_ending(const recording::Table& table, const std::string& signal) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (recording::signal_of(table.columns[c].name) == signal) found.push_back(c);
  return found;
}

References row_of(const recording::Table& table, const std::vector<std::size_t>& columns,
                  std::size_t row) {
  References all;
  for (const std::size_t c : columns) all.push_back(table.columns[c].values[row]);
  return all;
}

double most_apart(const References& a, const References& b) {
  double most = 0;
  for (std::size_t c = 0; c < a.size(); ++c) most = std::max(most, std::abs(a[c] - b[c]));
  return most;
}

References midway(References a, const References& b) {
  for (std::size_t c = 0; c < a.size(); ++c) a[c] = (a[c] + b[c]) / 2;
  return a;
}

/// References that stay constant for at least 0.5 s, each once.
std::vector<References> holds(const recording::Table& table,
                              const std::vector<std::size_t>& columns) {
  constexpr double still_m = 1e-5, least_s = 0.5;  // chosen
  const auto& time_s = table.columns.front().values;
  std::vector<References> found;
  for (std::size_t begin = 0, end = 0; begin < table.rows(); begin = end) {
    const References here = row_of(table, columns, begin);
    for (end = begin;
         end < table.rows() && most_apart(here, row_of(table, columns, end)) < still_m;)
      ++end;
    if (time_s[end - 1] - time_s[begin] >= least_s) found.push_back(here);
  }
  return found;
}

}  // namespace

int calibrate_tour(const TourOptions& options, std::ostream& out) {
  const recording::Table plan = recording::read_table(options.lengths);
  const auto references = columns_ending(plan, "reference");
  const auto held = holds(plan, references);
  if (held.size() < 2)
    throw std::invalid_argument(options.lengths +
                                ": holds fewer than two poses for half a second; use a trajectory "
                                "of line lengths, as written by erp model lengths");
  recording::Table tour;
  for (const auto& column : plan.columns) tour.columns.push_back({column.name, {}});
  double time_s = 0;
  const auto add = [&](const References& pose) {
    for (std::size_t c = 1; c < tour.columns.size(); ++c)
      tour.columns[c].values.push_back(plan.columns[c].values.front());
    for (std::size_t k = 0; k < references.size(); ++k)
      tour.columns[references[k]].values.back() = pose[k];
    tour.columns[0].values.push_back(time_s);
  };
  const auto hold = [&](const References& pose) {
    time_s += options.move_s, add(pose);
    time_s += options.hold_s, add(pose);
  };
  add(row_of(plan, references, 0));
  for (std::size_t k = 0; k < held.size(); ++k)
    hold(held[k]), hold(midway(held[k], held[(k + 1) % held.size()]));
  recording::write_csv(tour, out);
  return 0;
}

}  // namespace launch
