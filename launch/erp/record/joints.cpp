#include "launch/erp/record/joints.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <numbers>
#include <ostream>

#include "interfaces/recording/mcap_reader.hpp"
#include "launch/erp/record/plot.hpp"
#include "launch/erp/verbs/guarded.hpp"
#include "sim/model/skeleton/joint_path.hpp"

namespace launch {
namespace {

constexpr double period_s = 0.002;  // between two frames: the control cycle of the ECUs
constexpr double degrees_per_rad = 180 / std::numbers::pi;
constexpr std::size_t max_points_per_joint = 2000;  // more than a screen has columns; chosen

using Position = std::array<double, 4>;

erp::JointType type_of(int dof) {
  return dof == 3 ? erp::JointType::spherical : erp::JointType::revolute;
}

/// The rotation vector, in rad, that turns `from` into `to`; of a revolute joint the difference of
/// angles in [0].
std::array<double, 3> difference(int dof, const Position& from, const Position& to) {
  return sim::displacement(type_of(dof), from, to);
}

/// The joint angle in [0], or the rotation vector of a spherical joint from its zero pose, in rad.
std::array<double, 3> angles(int dof, const Position& position) {
  return difference(dof, dof == 3 ? Position{1, 0, 0, 0} : Position{}, position);
}

std::string curve(const recording::JointTrack& track, std::size_t axis) {
  const std::size_t stride = 1 + track.positions.size() / max_points_per_joint;
  std::string points;
  std::size_t k = 0;
  for (const auto& [sequence, position] : track.positions)
    if (k++ % stride == 0)
      points += fmt::format("{:.4f} {:.5f}\n", period_s * static_cast<double>(sequence),
                            degrees_per_rad * angles(track.dof, position)[axis]);
  return points;
}

PlotScript script(const recording::JointTracks& actual, const recording::JointTracks& desired,
                  const LogJointsOptions& options) {
  PlotScript plot;
  std::string data, panels;
  for (const auto& [joint, track] : actual) {
    const auto desired_track = desired.find(joint);
    if (desired_track == desired.end()) continue;
    for (std::size_t axis = 0; axis < (track.dof == 3 ? 3U : 1U); ++axis) {
      const int n = plot.panels++;
      data += fmt::format("$actual{} << E\n{}E\n$desired{} << E\n{}E\n", n, curve(track, axis), n,
                          curve(desired_track->second, axis));
      panels += fmt::format(
          "set ylabel '{}{}  [°]'\n"
          "plot $actual{} with lines lc rgb '#0072B2' lw 2 title '{}', $desired{} with lines dt 2 "
          "lw 2 "
          "lc rgb '#D55E00' title '{}'\n",
          joint, track.dof == 3 ? std::string(" ") + "xyz"[axis] : "", n, options.source, n,
          options.reference_source);
    }
  }
  plot.commands = data + "set grid\nset key outside right\nset multiplot layout " +
                  std::to_string(plot.panels) + ",1\nset xlabel 'time  [s]'\n" + panels +
                  "unset multiplot\n";
  return plot;
}

void print(const std::vector<JointError>& errors, const LogJointsOptions& options,
           std::ostream& out) {
  out << fmt::format("{} against {}\n{:<24} {:>8} {:>12} {:>12} {:>10}\n", options.source,
                     options.reference_source, "joint", "frames", "RMS error", "largest", "at");
  for (const JointError& e : errors)
    out << fmt::format("{:<24} {:>8} {:>11.3f}° {:>11.3f}° {:>8.2f} s\n", e.joint, e.frames,
                       degrees_per_rad * e.rms_rad, degrees_per_rad * e.largest_rad,
                       e.largest_at_s);
}

}  // namespace

std::vector<JointError> joint_errors(const recording::JointTracks& actual,
                                     const recording::JointTracks& desired, double from_s) {
  std::vector<JointError> errors;
  for (const auto& [joint, track] : actual) {
    const auto desired_track = desired.find(joint);
    if (desired_track == desired.end()) continue;
    JointError e{joint};
    for (const auto& [sequence, position] : track.positions) {
      const auto same_frame = desired_track->second.positions.find(sequence);
      const double time_s = period_s * static_cast<double>(sequence);
      if (same_frame == desired_track->second.positions.end() || time_s < from_s) continue;
      const auto u = difference(track.dof, position, same_frame->second);
      const double error_rad = std::hypot(u[0], u[1], u[2]);
      e.rms_rad += error_rad * error_rad;
      ++e.frames;
      if (error_rad > e.largest_rad) e.largest_rad = error_rad, e.largest_at_s = time_s;
    }
    if (e.frames > 0) e.rms_rad = std::sqrt(e.rms_rad / static_cast<double>(e.frames));
    errors.push_back(e);
  }
  return errors;
}

int log_joints(const std::string& path, const LogJointsOptions& options, std::ostream& out) {
  return guarded([&] {
    const recording::McapReader reader(path);
    const auto actual = recording::joint_tracks(reader, options.source);
    const auto desired = recording::joint_tracks(reader, options.reference_source);
    print(joint_errors(actual, desired, options.from_s), options, out);
    if (!options.out.empty()) draw(script(actual, desired, options), options.out);
    return flush_or_throw(out);
  });
}

}  // namespace launch
