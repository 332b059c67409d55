// Reproduces figure 6b of the paper for every prototype: a force step from 2 N to 40 N on each
// muscle, with all joints locked. The force law of the ECU controls the force. Exits with 1 if a
// row exceeds its limits.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "launch/erp/text/gnuplot.hpp"
#include "sim/model/actuator/spring.hpp"
#include "tests/sim/world/limb.hpp"

namespace {

constexpr double low_N = 2, high_N = 40, tick_s = 0.002;
constexpr double max_rise_ratio = 1.3;                                   // chosen
constexpr double paper_rise_s = 0.318, paper_steady_error_N = 0.236;     // Fig. 6
constexpr int before_ticks = 500, rise_ticks = 1000, rest_ticks = 1000;  // chosen

struct Step {
  std::string actuator;
  std::vector<double> force_N;  ///< at each tick after the step
  double rise_s = 0;            ///< from 10 to 90 %
  double shortest_rise_s = 0;   ///< rise time at the motor's no-load speed
  double steady_error_N = 0;    ///< RMS error in the last `rest_ticks`

  double limit_s() const { return std::max(paper_rise_s, max_rise_ratio * shortest_rise_s); }
  bool is_within_limits() const {
    return rise_s <= limit_s() && steady_error_N <= paper_steady_error_N;
  }
};

/// The force at a fraction of the step.
double level_N(double fraction) { return low_N + fraction * (high_N - low_N); }

/// Shortest rise time: the motor winds up the elongation between 10 and 90 % at its no-load speed.
double shortest_rise_s(const erp::Robot& robot, const erp::Actuator& actuator) {
  const erp::MotorType& motor = robot.motor_of(actuator);
  const auto spring = sim::Spring::of(actuator.tendon);
  const double line_m = spring.stretch_m(level_N(0.9)) - spring.stretch_m(level_N(0.1));
  const double top_rad_per_s = motor.supply_V / (motor.back_emf_V_s_per_rad * motor.gear_ratio);
  return line_m / (top_rad_per_s * actuator.spindle.radius_m);
}

void evaluate(Step& step) {
  const auto time_of_reaching_s = [&](double force_N) {
    const auto first_sample =
        std::ranges::find_if(step.force_N, [&](double f) { return f >= force_N; });
    return first_sample == step.force_N.end()
               ? INFINITY
               : tick_s * static_cast<double>(first_sample - step.force_N.begin());
  };
  step.rise_s = time_of_reaching_s(level_N(0.9)) - time_of_reaching_s(level_N(0.1));
  double square_sum_N2 = 0;
  for (std::size_t k = rise_ticks; k < step.force_N.size(); ++k)
    square_sum_N2 += std::pow(step.force_N[k] - high_N, 2);
  step.steady_error_N = std::sqrt(square_sum_N2 / rest_ticks);
}

/// Steps of all muscles of a robot at once. Locked joints decouple them.
std::vector<Step> steps_of(const erp::Robot& robot) {
  sim::WorldOptions options;
  for (const erp::Joint& joint : robot.joints()) options.lock.push_back(joint.name);
  Limb limb(robot, options);
  std::vector<Step> steps;
  for (const erp::Actuator& actuator : robot.actuators)
    steps.push_back({.actuator = actuator.name,
                     .force_N = {},
                     .shortest_rise_s = shortest_rise_s(robot, actuator)});
  const auto tick = [&](double force_N) {
    limb.command(ECU_REQUEST_FORCE, std::vector<double>(steps.size(), 1000 * force_N));
    limb.ecus.tick(limb.world);
  };
  for (int k = 0; k < before_ticks; ++k) tick(low_N);
  for (int k = 0; k < rise_ticks + rest_ticks; ++k) {
    tick(high_N);
    for (std::size_t a = 0; a < steps.size(); ++a)
      steps[a].force_N.push_back(limb.world.actuators()[a].tension_N);
  }
  for (Step& step : steps) evaluate(step);
  return steps;
}

bool print(const std::string& name, const std::vector<Step>& steps) {
  const auto slowest_step =
      std::ranges::max_element(steps, {}, [](const Step& s) { return s.rise_s / s.limit_s(); });
  const auto worst = std::ranges::max_element(steps, {}, &Step::steady_error_N);
  const auto within_limits = std::ranges::count_if(steps, &Step::is_within_limits);
  std::printf("| %-10s | %3zu | %6.0f | %6.0f | %6.0f | %-22s | %6.3f | %-22s | %3td |\n",
              name.c_str(), steps.size(), 1e3 * slowest_step->rise_s,
              1e3 * slowest_step->shortest_rise_s, 1e3 * slowest_step->limit_s(),
              slowest_step->actuator.c_str(), worst->steady_error_N, worst->actuator.c_str(),
              within_limits);
  std::fflush(stdout);
  return within_limits == std::ssize(steps);
}

launch::PlotScript script(const std::map<std::string, Step>& slowest_steps) {
  std::string data, curves;
  int n = 0;
  for (const auto& [name, step] : slowest_steps) {
    data += "$s" + std::to_string(n) + " << E\n";
    for (std::size_t k = 0; k < rise_ticks / 2; ++k)
      data +=
          std::to_string(1e3 * tick_s * double(k)) + " " + std::to_string(step.force_N[k]) + "\n";
    data += "E\n";
    curves += (n ? ", $s" : "plot $s") + std::to_string(n) + " with lines lw 2 title '" + name +
              ", " + step.actuator + "'";
    ++n;
  }
  return {data +
              "set grid\nset key outside right\nset xlabel 'time since the step  [ms]'\n"
              "set ylabel 'tension  [N]'\n" +
              curves + "\n",
          2};
}

}  // namespace

int main(int argc, char** argv) {
  std::printf(
      "force step from 2 N to 40 N on each muscle, joints locked; rise time from 10 to 90 %% in "
      "ms; force in N\n"
      "| robot | muscles | slowest rise | at no-load speed | limit | muscle | largest RMS error at "
      "40 N | muscle | within limits |\n|---|---|---|---|---|---|---|---|---|\n");
  std::map<std::string, Step> slowest_steps;
  bool within_limits = true;
  for (const std::string name : {"hinge_rig", "twin_joint", "seven_dof", "pendulum", "arm", "ecce1",
                                 "ecce2", "ecce3", "ecce4"}) {
    const auto steps = steps_of(erp::read_robot(ERP_SOURCE_DIR "/configs/" + name + "/robot.xml"));
    within_limits = print(name, steps) && within_limits;
    slowest_steps[name] = *std::ranges::max_element(steps, {}, &Step::rise_s);
  }
  if (argc > 1) launch::draw(script(slowest_steps), argv[1]);
  return within_limits ? 0 : 1;
}
