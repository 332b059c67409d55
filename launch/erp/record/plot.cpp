#include "launch/erp/record/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "interfaces/recording/error.hpp"
#include "interfaces/values.hpp"

namespace launch {
namespace {

using recording::Column;
using recording::Table;
using Values = std::vector<double>;

/// One panel: its signal, its label with unit, and the control mode whose references it shows.
struct Panel {
  const char* signal;
  const char* label;
  double scale;
  erp::Mode mode;
  bool is_default;  ///< shown by default
};
constexpr double degrees = 180 / std::numbers::pi;
constexpr Panel panels[] = {{"tension_N", "tension  [N]", 1, erp::Mode::force, true},
                            {"line_m", "line length  [mm]", 1e3, erp::Mode::length, true},
                            {"shaft_rad", "shaft  [rad]", 1, erp::Mode::off, false},
                            {"voltage_V", "voltage  [V]", 1, erp::Mode::voltage, false},
                            {"current_A", "current  [A]", 1, erp::Mode::current, false},
                            {"angle_rad", "joint angle  [°]", degrees, erp::Mode::off, true},
                            {"qw", "joint rotation  [°]", 2 * degrees, erp::Mode::off, true}};

// Colours for colour-blind readers, by Okabe & Ito and by Tol. Colours of joints start at
// `first_joint_colour`.
constexpr std::array<unsigned, 12> colours{0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7,
                                           0xE69F00, 0x56B4E9, 0x882255, 0x44AA99,
                                           0x999933, 0x332288, 0xAA4499, 0x661100};
constexpr std::size_t first_joint_colour = 6;
constexpr std::size_t max_points_per_curve = 2000;  // per curve; more than a screen has columns
constexpr std::size_t max_legend_entries = 14;      // entries that fit beside one panel

/// A literal gnuplot string. Quotes and backquotes are replaced: gnuplot never executes the text.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '`') out += "’";
    else if (static_cast<unsigned char>(c) >= 0x20) out += c;
  }
  return out + "'";
}

std::string rgb(unsigned colour) {
  std::array<char, 16> text;
  std::snprintf(text.data(), text.size(), "'#%06X'", colour);
  return text.data();
}
/// Half the brightness: a reference is then visible on top of the measured curve.
unsigned darkened(unsigned colour) { return (colour >> 1) & 0x7F7F7F; }

std::string number(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

void put_point(std::string& out, double time_s, double value) {
  out += number(time_s) + " " + number(value) + "\n";
}

/// Minimum and maximum of each interval of samples: no peak is lost. A blank line interrupts the
/// curve where no value was measured.
std::string decimated(const Values& time_s, const Values& values) {
  const std::size_t interval = std::max<std::size_t>(1, 2 * values.size() / max_points_per_curve);
  std::string out;
  for (std::size_t start = 0; start < values.size(); start += interval) {
    std::size_t low = values.size(), high = values.size();
    for (std::size_t i = start; i < std::min(start + interval, values.size()); ++i) {
      if (!std::isfinite(values[i])) continue;
      if (low == values.size() || values[i] < values[low]) low = i;
      if (high == values.size() || values[i] > values[high]) high = i;
    }
    if (low == values.size()) {
      if (!out.empty() && !out.ends_with("\n\n")) out += "\n";
      continue;
    }
    put_point(out, time_s[std::min(low, high)], values[std::min(low, high)]);
    if (low != high) put_point(out, time_s[std::max(low, high)], values[std::max(low, high)]);
  }
  return out;
}

/// Desired values in the unit of the panel: the reference while the ECU follows it, otherwise the
/// target.
Values desired_values(const Table& table, const std::string& owner, const Panel& panel) {
  const auto pick = [&](const char* mode_name, const char* value_name, std::size_t row) {
    const Column* mode = table.find(owner + mode_name);
    const Column* value = table.find(owner + value_name);
    const bool in_mode = mode && value && mode->values[row] == static_cast<double>(panel.mode);
    return in_mode ? value->values[row] : recording::not_taken;
  };
  Values values(table.rows(), recording::not_taken);
  if (panel.mode == erp::Mode::off) return values;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    values[row] = pick(".mode", ".reference", row);
    if (std::isnan(values[row])) values[row] = pick(".target_mode", ".target", row);
    values[row] *= panel.scale;
  }
  return values;
}

Values measured_values(const Column& column, const Panel& panel) {
  Values values = column.values;
  // A unit quaternion is a rotation by 2 acos |w| about any axis.
  if (std::string_view(panel.signal) == "qw")
    for (double& w : values) w = std::acos(std::min(1.0, std::abs(w)));
  for (double& value : values) value *= panel.scale;
  return values;
}

bool is_selected(const std::vector<std::string>& signals, const std::string& owner,
                 const Panel& panel) {
  if (signals.empty()) return panel.is_default;
  return std::ranges::any_of(signals, [&](const std::string& signal) {
    return (signal == owner && panel.is_default) || signal == panel.signal ||
           signal == owner + "." + panel.signal;
  });
}

class Script {
 public:
  Script(const Table& table, const std::vector<std::string>& signals)
      : table_(table), time_s_(table.columns.front().values) {
    for (const Panel& panel : panels) add(panel, signals);
  }

  PlotScript finish(const std::string& title) const {
    const double from_s = time_s_.empty() ? 0 : time_s_.front();
    const double to_s = time_s_.empty() || time_s_.back() <= from_s ? from_s + 1 : time_s_.back();
    const double height = picture_height(static_cast<int>(plots_.size()));
    std::string out = data_ + "set multiplot layout " + std::to_string(plots_.size()) +
                      ",1 title " + quoted(title) +
                      " font ',15' noenhanced margins screen 0.065,0.83," + number(60.0 / height) +
                      "," + number(1 - 50.0 / height) + " spacing screen 0," +
                      number(22.0 / height) +
                      "\n"
                      "set border 3 linecolor '#777777'\nset grid linecolor '#dddddd' linetype 1\n"
                      "set tics nomirror textcolor '#333333'\nset xrange [" +
                      number(from_s) + ":" + number(to_s) +
                      "]\nset key at screen 0.84, graph 1.02 left top Left reverse noenhanced "
                      "samplen 2 spacing 1.2\n"
                      "set ylabel noenhanced\nset format x ''\n";
    for (std::size_t i = 0; i < plots_.size(); ++i) {
      if (i + 1 == plots_.size()) out += "set format x '%g'\nset xlabel 'time  [s]'\n";
      out += plots_[i];
    }
    return {out + "unset multiplot\n", static_cast<int>(plots_.size())};
  }
  bool empty() const { return plots_.empty(); }

 private:
  std::string block(const Values& values) {
    const std::string points = decimated(time_s_, values);
    if (points.empty()) return {};
    const std::string name = "$d" + std::to_string(blocks_++);
    data_ += name + " << EOD\n" + points + "EOD\n";
    return name;
  }

  void add(const Panel& panel, const std::vector<std::string>& signals) {
    constexpr auto* dashes = " with lines linewidth 1.3 dashtype (9,6) linecolor rgb ";
    const std::string_view signal = panel.signal;
    const bool is_joint = signal == "angle_rad" || signal == "qw";
    std::string measured, desired;
    std::size_t curve = 0;
    for (const std::string& owner : table_.owners(signal)) {
      if (!is_selected(signals, owner, panel)) continue;
      const Column& column = *table_.find(owner + "." + panel.signal);
      const std::string data = block(measured_values(column, panel));
      if (data.empty()) continue;
      const unsigned colour =
          colours[(curve + (is_joint ? first_joint_colour : 0)) % colours.size()];
      measured += (measured.empty() ? "" : ", ") + data + " with lines linewidth 2 linecolor rgb " +
                  rgb(colour) +
                  (curve < max_legend_entries ? " title " + quoted(owner) : " notitle");
      const std::string reference = block(desired_values(table_, owner, panel));
      if (!reference.empty())
        desired += ", " + reference + dashes + rgb(darkened(colour)) + " notitle";
      ++curve;
    }
    if (measured.empty()) return;
    if (!desired.empty()) desired += std::string(", NaN") + dashes + "'#333333' title 'desired'";
    plots_.push_back("set ylabel " + quoted(panel.label) + "\nplot " + measured + desired + "\n");
  }

  const Table& table_;
  const Values& time_s_;
  std::string data_;
  std::vector<std::string> plots_;
  std::size_t blocks_ = 0;
};

/// Throws RecordingError if a requested signal matches no curve.
void check_signals(const Table& table, const std::vector<std::string>& signals,
                   const std::string& file) {
  for (const std::string& signal : signals) {
    bool is_found = false;
    std::string available;
    for (const Panel& panel : panels)
      for (const std::string& owner : table.owners(panel.signal)) {
        is_found = is_found || is_selected({signal}, owner, panel);
        available += (available.empty() ? "" : ", ") + owner + "." + panel.signal;
      }
    if (!is_found)
      throw recording::RecordingError(file + ": no signal \"" + signal + "\"; there are " +
                                      available);
  }
}

}  // namespace

PlotScript plot_script(const Table& table, const std::vector<std::string>& signals,
                       const std::string& title, const std::string& file) {
  check_signals(table, signals, file);
  const Script script(table, signals);
  if (script.empty())
    throw recording::RecordingError(
        file + ": contains no samples of the signals; see erp log info " + file);
  return script.finish(title);
}

}  // namespace launch
