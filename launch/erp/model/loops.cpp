#include "launch/erp/model/model.hpp"

#include <fmt/format.h>

#include <ostream>

#include "interfaces/recording/csv.hpp"
#include "interfaces/xml/xml.hpp"
#include "launch/erp/text/gnuplot.hpp"
#include "sim/control/loop_shaping/loop_curves.hpp"
#include "sim/control/pose_plan.hpp"

namespace launch {
namespace {

namespace shaping = sim::loop_shaping;

/// Sets the model to a pose, with all velocities zero.
void set_pose(sim::Musculoskeletal& model, const sim::Pose& pose) {
  std::vector<sim::JointReading> readings;
  for (std::size_t j = 0; j < pose.size(); ++j) {
    readings.push_back(sim::initial_reading(model.tree().joints[j]));
    readings.back().position = pose[j];
  }
  model.place(readings);
}

bool print_posture(const std::string& name, const shaping::LoopCheck& check, std::ostream& out) {
  const bool is_stable = check.slowest_per_s < 0;
  out << fmt::format("{:<10} {:>8} {:>14.2f} {:>13.2f}   ", name,
                     is_stable ? fmt::format("{:.3f}", check.margin) : "unstable",
                     check.slowest_per_s, check.max_sensitivity);
  for (const double hz : check.crossover_Hz) out << fmt::format(" {:.2f}", hz);
  out << '\n';
  return is_stable;
}

PlotScript script(const shaping::JointLoops& loops, const std::string& robot) {
  std::string data = "$loops << E\n";
  constexpr double from_Hz = 0.05, to_Hz = 50;  // chosen
  constexpr int points = 200;
  for (const auto& p : shaping::loop_curves(loops, from_Hz, to_Hz, points))
    data +=
        fmt::format("{:.5g} {:.5g} {:.5g} {:.5g} {:.5g} {:.5g} {:.5g}\n", p.Hz, p.desired.largest,
                    p.desired.smallest, p.achieved.largest, p.achieved.smallest, p.s, p.t);
  PlotScript plot{.panels = 2};
  plot.commands =
      data +
      "E\nset grid\nset key outside right\nset logscale xy\nset multiplot layout 2,1 title '" +
      robot +
      "'\nset xlabel 'frequency  [Hz]'\nset style fill transparent solid 0.3 noborder\n"
      "set ylabel 'singular values of the loop'\n"
      "plot $loops using 1:2:3 with filledcurves lc rgb '#D55E00' title 'desired shape', "
      "$loops using 1:4:5 with filledcurves lc rgb '#0072B2' title 'with K'\n"
      "set ylabel 'singular values of the closed loop'\n"
      "plot $loops using 1:6 with lines lw 2 lc rgb '#D55E00' title 'S: disturbances', "
      "$loops using 1:7 with lines lw 2 lc rgb '#0072B2' title 'T: tracking, noise'\n"
      "unset multiplot\n";
  return plot;
}

}  // namespace

int model_loops(const ModelLoopsOptions& options, std::ostream& out) {
  const erp::Robot robot = erp::read_robot(options.robot);
  const auto shape =
      options.loops.empty() ? shaping::JointShape{} : xml::read<shaping::JointShape>(options.loops);
  sim::Musculoskeletal model(robot);
  const shaping::JointLoops loops = shaping::joint_loops(model, shape);
  out << fmt::format(
      "{}: stability margin {:.3f}, maximum for this shape {:.3f} (0.25 or more is good)\n"
      "{:<10} {:>8} {:>14} {:>13}    {}\n",
      robot.name, loops.robust.margin, loops.robust.greatest_margin, "posture", "margin",
      "slowest pole", "sensitivity", "crossover by joint, Hz");
  bool is_stable = print_posture("start", checked(loops), out);
  if (!options.poses.empty())
    for (const auto& [time_s, pose] : sim::poses_of(recording::read_table(options.poses), robot)) {
      set_pose(model, pose);
      const auto check = checked(moved(loops, model, shape));
      is_stable = print_posture(fmt::format("{:.2f} s", time_s), check, out) && is_stable;
    }
  if (!options.out.empty()) draw(script(loops, robot.name), options.out);
  return is_stable ? 0 : 1;
}

}  // namespace launch
