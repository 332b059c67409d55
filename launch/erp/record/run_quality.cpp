#include "launch/erp/record/run_quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <ostream>

#include "interfaces/recording/error.hpp"
#include "interfaces/recording/fields.hpp"
#include "interfaces/recording/joint_tracks.hpp"
#include "interfaces/recording/ros2msg.hpp"
#include "launch/erp/record/joints.hpp"

namespace launch {
namespace {

// All chosen.
constexpr double saturated_fraction = 0.98;  // of the supply voltage
constexpr double min_taut_N = 0.5, slack_sigmas = 6;
constexpr double reported_share = 0.05;
constexpr double good_deg = 1, fair_deg = 3;  // RMS error of a joint

double share_of(const recording::Column* mode, const recording::Column* signal, auto is_reached) {
  std::size_t running = 0, reached = 0;
  for (std::size_t row = 0; mode && signal && row < mode->values.size(); ++row) {
    if (!(mode->values[row] > 0) || std::isnan(signal->values[row])) continue;
    ++running, reached += is_reached(signal->values[row]);
  }
  return running ? static_cast<double>(reached) / static_cast<double>(running) : 0;
}

/// The joint angles of the best recorded source; the truth of a simulator first.
std::optional<recording::JointTracks> measured_joints(const recording::McapReader& recording) {
  for (const char* source : {"sim", "motion_capture", "pose_estimator"}) try {
      return recording::joint_tracks(recording, source);
    } catch (const recording::RecordingError&) {  // not recorded
    }
  return std::nullopt;
}

std::vector<JointError> errors_of(const recording::McapReader& recording) {
  const auto measured = measured_joints(recording);
  if (!measured) return {};
  try {
    return joint_errors(*measured, recording::joint_tracks(recording, "joint_target"), 0);
  } catch (const recording::RecordingError&) {  // no target was recorded
    return {};
  }
}

std::uint64_t count_in(const recording::Members& members, const char* field) {
  const double number = recording::number_in(members, field);
  return number > 0 ? static_cast<std::uint64_t>(number) : 0;
}

const char* grade(double rms_deg) {
  if (rms_deg <= good_deg) return "good";
  return rms_deg <= fair_deg ? "fair" : "poor";
}

void print_joints(const std::vector<JointError>& errors, std::ostream& out) {
  constexpr double deg_per_rad = 180 / std::numbers::pi;
  if (errors.empty()) return;
  out << fmt::format("{:<20} {:<8} {:>14} {:>14}\n", "joint", "", "RMS error", "largest");
  for (const JointError& error : errors)
    out << fmt::format("{:<20} {:<8} {:>12.2f} ° {:>12.2f} °\n", error.joint,
                       grade(deg_per_rad * error.rms_rad), deg_per_rad * error.rms_rad,
                       deg_per_rad * error.largest_rad);
  out << fmt::format("an RMS error up to {:.0f}° is good, up to {:.0f}° fair\n", good_deg,
                     fair_deg);
}

void print_load(const ActuatorLoad& load, std::ostream& out) {
  if (load.saturated > reported_share)
    out << fmt::format(
        "{}: its motor is saturated for {:.0f} % of the time in which its ECU runs: the reference "
        "is too fast, or the "
        "load "
        "too large\n",
        load.actuator, 100 * load.saturated);
  if (load.slack > reported_share)
    out << fmt::format("{}: its tendon is slack for {:.0f} % of the time in which its ECU runs\n",
                       load.actuator, 100 * load.slack);
}

}  // namespace

std::vector<ActuatorLoad> actuator_loads(const recording::Table& table, const erp::Robot& robot) {
  std::vector<ActuatorLoad> loads;
  for (const erp::Actuator& actuator : robot.actuators) {
    const auto* mode = table.find(actuator.name + ".mode");
    const double full_V = saturated_fraction * robot.motor_of(actuator).supply_V;
    const double taut_N =
        std::max(min_taut_N, slack_sigmas * robot.sensors_of(actuator).tension_noise_N);
    loads.push_back({actuator.name,
                     share_of(mode, table.find(actuator.name + ".voltage_V"),
                              [&](double V) { return std::abs(V) >= full_V; }),
                     share_of(mode, table.find(actuator.name + ".tension_N"),
                              [&](double N) { return N < taut_N; })});
  }
  return loads;
}

std::vector<LimitedReferences> limited_references(const recording::McapReader& recording,
                                                  const std::string& robot) {
  recording::TypeDescription type;
  recording::Bytes last;  // the last message of the robot
  recording.for_each(
      [&](const recording::Message& message) {
        if (message.channel.topic != "actuator_owner") return;
        if (type.structures.empty()) {
          const auto& schema = recording.schemas().at(message.channel.schema_id);
          type = recording::parse_ros2msg(schema.name, schema.data);
        }
        if (recording::header_of(type, message.data).robot == robot)
          last.assign(message.data.begin(), message.data.end());
      },
      recording::Order::file);
  std::vector<LimitedReferences> all;
  if (last.empty()) return all;
  recording::each_in(
      recording::decode_cdr(type, last), "actuators", [&](const recording::Members& sample) {
        const LimitedReferences counts{recording::text_in(sample, "name"),
                                       recording::text_in(sample, "reason"),
                                       count_in(sample, "limited"), count_in(sample, "refused")};
        if (counts.limited || counts.refused) all.push_back(counts);
      });
  return all;
}

void print_quality(const recording::McapReader& recording, const recording::Table& table,
                   const erp::Robot& robot, std::ostream& out) {
  print_joints(errors_of(recording), out);
  for (const ActuatorLoad& load : actuator_loads(table, robot)) print_load(load, out);
  for (const LimitedReferences& counts : limited_references(recording, robot.name))
    out << fmt::format("{}: {} references limited, {} refused: {}\n", counts.actuator,
                       counts.limited, counts.refused, counts.reason);
}

}  // namespace launch
