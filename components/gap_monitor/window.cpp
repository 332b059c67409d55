#include "components/gap_monitor/window.hpp"

#include <algorithm>
#include <stdexcept>

#include "interfaces/recording/columns.hpp"

namespace gap_monitor {
namespace {

constexpr double tick_s = 0.002;  // period of the sensor frames
constexpr double block_s = 0.5;   // chosen: length of the blocks that are compared

double value_or_missing(bool is_valid, double value) {
  return is_valid ? value : recording::not_taken;
}

/// The signals of an actuator, in the order of recording::actuator_signals.
void append_signals(std::vector<double>& row, const erp::SensorFrame& frame,
                    const erp::Actuator& a) {
  for (const auto& s : erp::samples(frame.actuators)) {
    if (s.name != a.name) continue;
    const auto has = [&](std::uint8_t bit) { return (s.valid & bit) != 0; };
    row.insert(row.end(), {double(s.mode), s.reference,
                           value_or_missing(has(erp::valid::voltage), s.voltage_V),
                           value_or_missing(has(erp::valid::current), s.current_A),
                           value_or_missing(has(erp::valid::shaft), s.shaft_rad),
                           value_or_missing(has(erp::valid::tension), s.tension_N)});
    return;
  }
  row.insert(row.end(), std::size(recording::actuator_signals), recording::not_taken);
}

double joint_angle_rad(const erp::SensorFrame& frame, const std::string& joint) {
  for (const auto& s : erp::samples(frame.joints))
    if (s.name == joint) return value_or_missing(s.valid & erp::valid::joint_angle, s.angle_rad);
  return recording::not_taken;
}

}  // namespace

Window::Window(const erp::Robot& model, double window_s)
    : model_(model), max_rows_(static_cast<std::size_t>(window_s / tick_s)) {
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
    double* position = joint_state_.data();
    for (const erp::Joint& joint : model_.joints()) {
      if (joint.type != erp::JointType::spherical) continue;
      if (sample.name == joint.name) std::copy_n(sample.position, 4, position);
      position += 4;
    }
  }
}

void Window::receive(const erp::SensorFrame& frame) {
  std::vector<double> row{1e-9 * static_cast<double>(frame.stamp_ns),
                          static_cast<double>(frame.sequence)};
  for (const erp::Actuator& a : model_.actuators) append_signals(row, frame, a);
  const double* pose = joint_state_.data();
  for (const erp::Joint& joint : model_.joints()) {
    if (joint.type == erp::JointType::revolute) row.push_back(joint_angle_rad(frame, joint.name));
    if (joint.type == erp::JointType::spherical) row.insert(row.end(), pose, pose + 4), pose += 4;
  }
  std::ranges::fill(joint_state_, recording::not_taken);
  if (frame.stamp_ns < stamp_ns_) rows_.clear();  // a new run
  rows_.push_back(std::move(row));
  if (rows_.size() > max_rows_) rows_.pop_front();
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

std::vector<sim::diagnosis::StageGap> Window::evaluate(std::string& reason) const {
  reason.clear();
  if (!full()) return {};
  try {
    std::vector<std::string> remarks;
    const sim::residuals::Episode episodes[] = {
        sim::residuals::lay_out(table(), model_, "the last seconds", remarks)};
    return sim::diagnosis::localize(model_, episodes, {.block_s = block_s});
  } catch (const std::invalid_argument& error) {
    reason = error.what();
    return {};
  }
}

}  // namespace gap_monitor
