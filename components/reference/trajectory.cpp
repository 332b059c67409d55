#include "components/reference/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "interfaces/recording/table.hpp"

namespace reference {
namespace {

Trajectory::Column column_of(const recording::Table& table, const std::string& actuator,
                             const std::string& file) {
  const auto* mode = table.find(actuator + ".mode");
  const auto* value = table.find(actuator + ".reference");
  if (!mode)
    throw std::invalid_argument(file + ": no column \"" + actuator + ".mode\" beside \"" +
                                actuator +
                                ".reference\"; add one with voltage, length, current or force");
  Trajectory::Column column{actuator, {}, {}, {}};
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (std::isnan(value->values[row]) || std::isnan(mode->values[row])) continue;
    column.time_s.push_back(table.columns.front().values[row]);
    column.value.push_back(value->values[row]);
    column.mode.push_back(static_cast<erp::Mode>(std::lround(mode->values[row])));
  }
  if (column.time_s.empty())
    throw std::invalid_argument(file + ": \"" + actuator +
                                "\" has no row with both mode and reference; add one");
  return column;
}

}  // namespace

Trajectory::Trajectory(const std::string& file) {
  const auto table = recording::read_table(file);
  for (const auto& actuator : table.owners("reference"))
    columns_.push_back(column_of(table, actuator, file));
  if (columns_.empty())
    throw std::invalid_argument(file +
                                ": no column \"<actuator>.reference\"; add one per actuator");
  duration_s_ = table.find("time_s")->values.back();
}

std::size_t Trajectory::Column::row_before(double t_s) const {
  const auto after = std::upper_bound(time_s.begin(), time_s.end(), t_s);
  return after == time_s.begin() ? 0 : static_cast<std::size_t>(after - time_s.begin()) - 1;
}

double Trajectory::Column::at(double t_s) const {
  const std::size_t k = row_before(t_s);
  if (k + 1 >= value.size() || t_s <= time_s[k] || mode[k] != mode[k + 1]) return value[k];
  const double fraction = (t_s - time_s[k]) / (time_s[k + 1] - time_s[k]);
  return value[k] + fraction * (value[k + 1] - value[k]);
}

erp::Mode Trajectory::Column::mode_at(double t_s) const { return mode[row_before(t_s)]; }

}  // namespace reference
