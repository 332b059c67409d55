#include "components/gap_monitor/window.hpp"

#include <algorithm>
#include <stdexcept>

#include "interfaces/recording/columns.hpp"

namespace gap_monitor {
namespace {

constexpr double tick_s = 0.002;

double taken(bool was, double value) { return was ? value : recording::not_taken; }

/// The signals of an actuator, in the order of recording::actuator_signals.
void add(std::vector<double>& row, const erp::SensorFrame& frame, const erp::Actuator& a) {
  for (const auto& s : erp::samples(frame.actuators)) {
    if (s.name != a.name) continue;
    const auto has = [&](std::uint8_t bit) { return (s.valid & bit) != 0; };
    row.insert(
        row.end(),
        {double(s.mode), s.reference, taken(has(erp::valid::voltage), s.voltage_V),
         taken(has(erp::valid::current), s.current_A), taken(has(erp::valid::shaft), s.shaft_rad),
         taken(has(erp::valid::tension), s.tension_N)});
    return;
  }
  row.insert(row.end(), std::size(recording::actuator_signals), recording::not_taken);
}

double angle_in(const erp::SensorFrame& frame, const std::string& joint) {
  for (const auto& s : erp::samples(frame.joints))
    if (s.name == joint) return taken(s.valid & erp::valid::joint_angle, s.angle_rad);
  return recording::not_taken;
}

}  // namespace

Window::Window(const erp::Robot& model, double window_s)
    : model_(model), most_(static_cast<std::size_t>(window_s / tick_s)) {
  for (std::string& name : recording::columns_of(model_)) columns_.push_back(std::move(name));
  for (const erp::Joint& joint : model_.joints())
    if (joint.type == erp::JointType::spherical)
      joint_state_.resize(joint_state_.size() + 4, recording::not_taken);
}

void Window::receive(const erp::JointState& state) {
  const std::string_view source = state.source;
  if (source == "pose_estimator" || (source == "sim" && tracked_)) return;
  tracked_ |= source == "motion_capture";
  for (const auto& sample : erp::samples(state.joints)) {
    double* at = joint_state_.data();
    for (const erp::Joint& joint : model_.joints()) {
      if (joint.type != erp::JointType::spherical) continue;
      if (sample.name == joint.name) std::copy_n(sample.position, 4, at);
      at += 4;
    }
  }
}

void Window::receive(const erp::SensorFrame& frame) {
  std::vector<double> row{1e-9 * static_cast<double>(frame.stamp_ns),
                          static_cast<double>(frame.sequence)};
  for (const erp::Actuator& a : model_.actuators) add(row, frame, a);
  const double* pose = joint_state_.data();
  for (const erp::Joint& joint : model_.joints()) {
    if (joint.type == erp::JointType::revolute) row.push_back(angle_in(frame, joint.name));
    if (joint.type == erp::JointType::spherical) row.insert(row.end(), pose, pose + 4), pose += 4;
  }
  std::ranges::fill(joint_state_, recording::not_taken);
  if (frame.stamp_ns < stamp_ns_) rows_.clear();  // a new run
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

std::vector<sim::diagnosis::StageGap> Window::evaluate(std::string& why) const {
  why.clear();
  if (!full()) return {};
  try {
    std::vector<std::string> remarks;
    const sim::residuals::Episode last[] = {
        sim::residuals::lay_out(table(), model_, "the last seconds", remarks)};
    return sim::diagnosis::localize(model_, last, {.block_s = 0.5});
  } catch (const std::invalid_argument& failed) {
    why = failed.what();
    return {};
  }
}

}  // namespace gap_monitor
