#include "components/gap_monitor/window.hpp"

#include <algorithm>
#include <stdexcept>

namespace gap_monitor {
namespace {

constexpr double tick_s = 0.002;

double taken(bool was, double value) { return was ? value : recording::not_taken; }

}  // namespace

Window::Window(const erp::Robot& model, double window_s)
    : model_(model), most_(static_cast<std::size_t>(window_s / tick_s)) {
  name_columns();
}

void Window::name_columns() {
  columns_ = {"time_s", "sequence"};
  for (const erp::Actuator& a : model_.actuators)
    for (const char* signal :
         {"mode", "reference", "voltage_V", "current_A", "shaft_rad", "tension_N"})
      columns_.push_back(a.name + "." + signal);
  for (const erp::Joint& joint : model_.joints())
    if (joint.type == erp::JointType::revolute) columns_.push_back(joint.name + ".angle_rad");
  for (const erp::Joint& joint : model_.joints())
    if (joint.type == erp::JointType::spherical)
      for (const char* part : {".qw", ".qx", ".qy", ".qz"}) {
        columns_.push_back(joint.name + part);
        joint_state_.push_back(recording::not_taken);
      }
}

void Window::hear(const erp::JointState& state) {
  std::size_t at = 0;
  for (const erp::Joint& joint : model_.joints()) {
    if (joint.type != erp::JointType::spherical) continue;
    for (const auto& sample : erp::samples(state.joints))
      if (sample.name == joint.name)
        std::copy_n(sample.position, 4, joint_state_.begin() + long(at));
    at += 4;
  }
}

void Window::hear(const erp::SensorFrame& frame) {
  std::vector<double> row{1e-9 * static_cast<double>(frame.stamp_ns),
                          static_cast<double>(frame.sequence)};
  row.resize(columns_.size(), recording::not_taken);
  std::size_t column = 2;
  for (const erp::Actuator& a : model_.actuators) {
    for (const auto& s : erp::samples(frame.actuators)) {
      if (s.name != a.name) continue;
      const auto has = [&](std::uint8_t bit) { return (s.valid & bit) != 0; };
      const double values[] = {double(s.mode),
                               s.reference,
                               taken(has(erp::valid::voltage), s.voltage_V),
                               taken(has(erp::valid::current), s.current_A),
                               taken(has(erp::valid::shaft), s.shaft_rad),
                               taken(has(erp::valid::tension), s.tension_N)};
      std::ranges::copy(values, row.begin() + long(column));
    }
    column += 6;
  }
  for (const erp::Joint& joint : model_.joints()) {
    if (joint.type != erp::JointType::revolute) continue;
    for (const auto& s : erp::samples(frame.joints))
      if (s.name == joint.name) row[column] = taken(s.valid & erp::valid::joint_angle, s.angle_rad);
    ++column;
  }
  std::ranges::copy(joint_state_, row.begin() + long(column));
  rows_.push_back(std::move(row));
  if (rows_.size() > most_) rows_.pop_front();
  stamp_ns_ = frame.stamp_ns;
}

recording::Table Window::table() const {
  recording::Table table;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    recording::Column column{columns_[c], {}};
    for (const auto& row : rows_) column.values.push_back(row[c]);
    table.columns.push_back(std::move(column));
  }
  return table;
}

std::vector<sim::diagnosis::StageGap> Window::judge(std::string& why) const {
  why.clear();
  if (!full()) return {};
  try {
    std::vector<std::string> mended;
    const sim::diagnosis::Episode last[] = {
        sim::diagnosis::lay_out(table(), model_, "the last seconds", mended)};
    return sim::diagnosis::where(model_, last, {.block_s = 0.5});
  } catch (const std::invalid_argument& failed) {
    why = failed.what();
    return {};
  }
}

}  // namespace gap_monitor
