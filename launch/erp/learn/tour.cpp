#include <cmath>
#include <ostream>

#include "interfaces/recording/csv.hpp"
#include "launch/erp/learn/calibrate.hpp"

namespace launch {
namespace {

using References = std::vector<double>;  ///< line length references of one row, in m, by column

std::vector<std::size_t> columns_ending(const recording::Table& table, const std::string& signal) {
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (recording::signal_of(table.columns[c].name) == signal) columns.push_back(c);
  return columns;
}

References row_of(const recording::Table& table, const std::vector<std::size_t>& columns,
                  std::size_t row) {
  References all;
  for (const std::size_t c : columns) all.push_back(table.columns[c].values[row]);
  return all;
}

double max_difference_m(const References& a, const References& b) {
  double max_m = 0;
  for (std::size_t c = 0; c < a.size(); ++c) max_m = std::max(max_m, std::abs(a[c] - b[c]));
  return max_m;
}

References midway(References a, const References& b) {
  for (std::size_t c = 0; c < a.size(); ++c) a[c] = (a[c] + b[c]) / 2;
  return a;
}

/// The references of each interval of at least `min_hold_s` in which they stay constant.
std::vector<References> held_references(const recording::Table& table,
                                        const std::vector<std::size_t>& columns) {
  constexpr double max_motion_m = 1e-5, min_hold_s = 0.5;  // chosen
  const auto& time_s = table.columns.front().values;
  std::vector<References> poses;
  for (std::size_t begin = 0, end = 0; begin < table.rows(); begin = end) {
    const References first = row_of(table, columns, begin);
    for (end = begin;
         end < table.rows() && max_difference_m(first, row_of(table, columns, end)) < max_motion_m;)
      ++end;
    if (time_s[end - 1] - time_s[begin] >= min_hold_s) poses.push_back(first);
  }
  return poses;
}

}  // namespace

int calibrate_tour(const TourOptions& options, std::ostream& out) {
  const recording::Table plan = recording::read_table(options.lengths);
  const auto references = columns_ending(plan, "reference");
  const auto held_poses = held_references(plan, references);
  if (held_poses.size() < 2)
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
  for (std::size_t k = 0; k < held_poses.size(); ++k)
    hold(held_poses[k]), hold(midway(held_poses[k], held_poses[(k + 1) % held_poses.size()]));
  recording::write_csv(tour, out);
  return 0;
}

}  // namespace launch
