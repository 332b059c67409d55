// Figure 6b of the paper for every prototype: a force step from 2 N to 40 N on each muscle, controlled by the force law of
// its ECU, with all joints locked. Exits with 1 if a row exceeds its limits.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "launch/erp/text/gnuplot.hpp"
#include "sim/model/actuator/spring.hpp"
#include "tests/sim/world/limb.hpp"

namespace {

constexpr double low_N = 2, high_N = 40, tick_s = 0.002;
constexpr double paper_rise_s = 0.318, paper_steady_N = 0.236;  // Fig. 6
constexpr int before = 500, rising = 1000, resting = 1000;      // ticks

struct Step {
  std::string actuator;
  std::vector<double> force_N;  ///< at each tick after the step
  double rise_s = 0;            ///< from 10 to 90 %
  double least_s = 0;           ///< the same at the motor's top speed
  double steady_N = 0;          ///< RMS error at rest

  double allowed_s() const { return std::max(paper_rise_s, 1.3 * least_s); }
  bool good() const { return rise_s <= allowed_s() && steady_N <= paper_steady_N; }
};

double level_N(double share) { return low_N + share * (high_N - low_N); }

/// Shortest rise time: the motor winds up the elongation between 10 and 90 % at its no-load speed.
double least_s(const erp::Robot& robot, const erp::Actuator& actuator) {
  const erp::MotorType& motor = robot.motor_of(actuator);
  const auto spring = sim::Spring::of(actuator.tendon);
  const double line_m = spring.stretch_m(level_N(0.9)) - spring.stretch_m(level_N(0.1));
  const double top_rad_per_s = motor.supply_V / (motor.back_emf_V_s_per_rad * motor.gear_ratio);
  return line_m / (top_rad_per_s * actuator.spindle.radius_m);
}

void evaluate(Step& step) {
  const auto reaches = [&](double force_N) {
    const auto found = std::ranges::find_if(step.force_N, [&](double f) { return f >= force_N; });
    return found == step.force_N.end() ? INFINITY
                                       : tick_s * static_cast<double>(found - step.force_N.begin());
  };
  step.rise_s = reaches(level_N(0.9)) - reaches(level_N(0.1));
  double squares = 0;
  for (std::size_t k = rising; k < step.force_N.size(); ++k)
    squares += std::pow(step.force_N[k] - high_N, 2);
  step.steady_N = std::sqrt(squares / resting);
}

/// Steps of all muscles of a robot at once. Locked joints decouple them.
std::vector<Step> steps_of(const erp::Robot& robot) {
  sim::WorldOptions held;
  for (const erp::Joint& joint : robot.joints()) held.lock.push_back(joint.name);
  Limb limb(robot, held);
  std::vector<Step> steps;
  for (const erp::Actuator& actuator : robot.actuators)
    steps.push_back(
        {.actuator = actuator.name, .force_N = {}, .least_s = least_s(robot, actuator)});
  const auto pull = [&](double force_N) {
    limb.command(ECU_REQUEST_FORCE, std::vector<double>(steps.size(), 1000 * force_N));
    limb.ecus.tick(limb.world);
  };
  for (int k = 0; k < before; ++k) pull(low_N);
  for (int k = 0; k < rising + resting; ++k) {
    pull(high_N);
    for (std::size_t a = 0; a < steps.size(); ++a)
      steps[a].force_N.push_back(limb.world.actuators()[a].tension_N);
  }
  for (Step& step : steps) evaluate(step);
  return steps;
}

bool print(const std::string& name, const std::vector<Step>& steps) {
  const auto slowest =
      std::ranges::max_element(steps, {}, [](const Step& s) { return s.rise_s / s.allowed_s(); });
  const auto worst = std::ranges::max_element(steps, {}, &Step::steady_N);
  const auto good = std::ranges::count_if(steps, &Step::good);
  std::printf("| %-10s | %3zu | %6.0f | %6.0f | %6.0f | %-22s | %6.3f | %-22s | %3td |\n",
              name.c_str(), steps.size(), 1e3 * slowest->rise_s, 1e3 * slowest->least_s,
              1e3 * slowest->allowed_s(), slowest->actuator.c_str(), worst->steady_N,
              worst->actuator.c_str(), good);
  std::fflush(stdout);
  return good == std::ssize(steps);
}

launch::PlotScript script(const std::map<std::string, Step>& slowest) {
  std::string data, curves;
  int n = 0;
  for (const auto& [name, step] : slowest) {
    data += "$s" + std::to_string(n) + " << E\n";
    for (std::size_t k = 0; k < rising / 2; ++k)
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
  std::map<std::string, Step> slowest;
  bool good = true;
  for (const std::string name : {"hinge_rig", "twin_joint", "seven_dof", "pendulum", "arm", "ecce1",
                                 "ecce2", "ecce3", "ecce4"}) {
    const auto steps = steps_of(erp::read_robot(ERP_SOURCE_DIR "/configs/" + name + "/robot.xml"));
    good = print(name, steps) && good;
    slowest[name] = *std::ranges::max_element(steps, {}, &Step::rise_s);
  }
  if (argc > 1) launch::draw(script(slowest), argv[1]);
  return good ? 0 : 1;
}
