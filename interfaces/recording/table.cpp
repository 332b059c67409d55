#include "interfaces/recording/table.hpp"

#include <algorithm>

#include "interfaces/recording/csv.hpp"
#include "interfaces/recording/mcap_reader.hpp"

namespace recording {

const Column* Table::find(std::string_view name) const {
  const auto found = std::ranges::find(columns, name, &Column::name);
  return found == columns.end() ? nullptr : &*found;
}

std::vector<std::string> Table::owners(std::string_view signal) const {
  std::vector<std::string> names;
  for (const Column& column : columns)
    if (signal_of(column.name) == signal && column.name.size() > signal.size())
      names.push_back(column.name.substr(0, column.name.size() - signal.size() - 1));
  return names;
}

const std::vector<std::string_view>& known_signals() {
  static const std::vector<std::string_view> signals{
      "mode",      "reference",  "voltage_V",    "current_A",   "shaft_rad",
      "tension_N", "line_m",     "target_mode",  "target",      "potentiometer_rad",
      "angle_rad", "qw",         "qx",           "qy",          "qz",
      "control_V", "position_m", "position_rad", "reference_m", "reference_rad",
      "pulse_V"};
  return signals;
}

std::string_view signal_of(std::string_view column) {
  const auto dot = column.rfind('.');
  return dot == column.npos ? column : column.substr(dot + 1);
}

std::string channel_name(int ecu, int channel) {
  return "ecu" + std::to_string(ecu) + "." + std::to_string(channel);
}

bool holds_mode(std::string_view column) {
  return column.ends_with(".mode") || column.ends_with(".target_mode");
}

Table read_table(const std::string& path, const TableOptions& options) {
  const InputFile file(path);
  const Bytes start = file.read(0, std::min<std::uint64_t>(file.size(), magic.size()));
  if (std::ranges::equal(start, std::as_bytes(std::span(magic))))
    return table_of(McapReader(path), options);
  if (path.ends_with(".mcap"))
    throw RecordingError(path + ": byte 0: this is not an MCAP file; is it the right one?");
  constexpr char xml_start = '<';
  if (!start.empty() && static_cast<char>(start[0]) == xml_start)
    throw RecordingError(path + ": byte 0: this is XML, not a recording; give a .mcap or .csv");
  return parse_csv(path, text(file.read(0, file.size())));
}

}  // namespace recording
