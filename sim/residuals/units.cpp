#include "sim/residuals/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/actuator/spring.hpp"
#include "sim/residuals/indices.hpp"

namespace sim::residuals {
namespace {

constexpr double together = 0.8;   // correlation, from which a slope is believed; chosen
constexpr double far_off = 3;      // times: few effects of a robot are as large; chosen
constexpr double beyond_all = 30;  // times: none is; chosen

/// y = slope · x + rest.
struct Line {
  double slope = 0, correlation = 0;
};

Line line_of(const Signal& x, const Signal& y) {
  double n = 0, sx = 0, sy = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k)
    if (const double a = x[k], b = y[k]; std::isfinite(a) && std::isfinite(b))
      ++n, sx += a, sy += b, xx += a * a, yy += b * b, xy += a * b;
  const double vx = xx - sx * sx / n, vy = yy - sy * sy / n, c = xy - sx * sy / n;
  if (!(n > 10 && vx > 0 && vy > 0)) return {};
  return {c / vx, c / std::sqrt(vx * vy)};
}

/// What a signal that is so many times too large looks like; empty: like no unit.
std::string looks_like(double times, double gear_ratio) {
  struct Unit {
    double times;
    const char* what;
  };
  const Unit units[] = {
      {180 / std::numbers::pi, "it looks like degrees: divide by 57.29578"},
      {1000, "it looks like thousandths of its unit (mA, mN, mV, mm): divide by 1000"},
      {1e-3, "it looks like thousands of its unit: multiply by 1000, or the time by 0.001"},
      {1 / 9.81, "it looks like kilograms: multiply by 9.81"},
      {gear_ratio, "it looks like the motor's shaft before the gearbox: divide by its ratio"},
      {1 / gear_ratio, "it looks as if divided by the gear ratio once more: multiply by it"}};
  for (const Unit& unit : units)
    if (std::abs(std::log(times / unit.times)) < 0.25) return unit.what;
  return times > beyond_all || times < 1 / beyond_all ? "check its unit" : "";
}

class Check {
 public:
  Check(const Episode& episode, const erp::Robot& robot)
      : e_(episode), robot_(robot), bones_(robot) {}

  std::vector<std::string> run() {
    const auto paths = bones_.paths(e_.joints, e_.rows, each(robot_.actuators.size()));
    for (std::size_t a = 0; a < robot_.actuators.size(); ++a)
      if (!robot_.actuators[a].tendon.path.empty() && motor(a)) tendon(a, paths[a]);
    const auto joints = robot_.joints();
    for (std::size_t j = 0; j < joints.size(); ++j) limits(joints[j], e_.joints[j].angle_rad);
    return std::move(odd_);
  }

 private:
  bool say(const std::string& column, double times, const std::string& of, double gear_ratio) {
    if (times < 0) {
      odd_.push_back(fmt::format("{}: {}: its sign is against {}: multiply the column by -1",
                                 e_.name, column, of));
      return false;
    }
    const std::string unit =
        times > far_off || times < 1 / far_off ? looks_like(times, gear_ratio) : "";
    if (!unit.empty())
      odd_.push_back(fmt::format("{}: {}: {:.3g} times what {} foretells: {}", e_.name, column,
                                 times, of, unit));
    return unit.empty();
  }

  /// Of the signal y, as many times too large as it answers to what foretells it. Whether it is in
  /// order.
  bool compare(const std::string& column, const Signal& foretold, const Signal& y,
               const std::string& of, double gear_ratio) {
    const Line line = line_of(foretold, y);
    return std::abs(line.correlation) <= together || say(column, line.slope, of, gear_ratio);
  }

  Signal speed_of(const Signal& shaft) const {
    Signal speed(shaft.size(), recording::not_taken);
    for (std::size_t k = 1; k + 1 < shaft.size(); ++k) speed[k] = rate_of(shaft, k, e_.period_s);
    return speed;
  }

  /// Whether the shaft is in order, by which the tendon is judged.
  bool motor(std::size_t a) {
    const erp::MotorType& m = robot_.motor_of(robot_.actuators[a]);
    const ActuatorSignals& s = e_.actuators[a];
    if (s.voltage_V.empty() || s.shaft_rad.empty()) return true;
    Signal speed = speed_of(s.shaft_rad), foretold(speed.size()), drop(speed.size());
    const double back_emf = m.back_emf_V_s_per_rad * m.gear_ratio;
    for (std::size_t k = 0; k < speed.size(); ++k) foretold[k] = s.voltage_V[k] / back_emf;
    const std::string& name = robot_.actuators[a].name;
    const bool good = compare(name + ".shaft_rad", foretold, speed, "the voltage", m.gear_ratio);
    if (s.current_A.empty()) return good;
    for (std::size_t k = 0; k < speed.size(); ++k)
      drop[k] = (s.voltage_V[k] - back_emf * speed[k]) / m.resistance_ohm;
    if (good) compare(name + ".current_A", drop, s.current_A, "the motor's law", m.gear_ratio);
    return good;
  }

  void tendon(std::size_t a, const PathTrace& path) {
    const erp::Actuator& actuator = robot_.actuators[a];
    const ActuatorSignals& s = e_.actuators[a];
    if (s.shaft_rad.empty() || path.length_m.empty()) return;
    Signal paid_out(e_.rows), stretch(e_.rows);
    for (std::size_t k = 0; k < e_.rows; ++k) {
      paid_out[k] = -actuator.spindle.radius_m * s.shaft_rad[k];
      stretch[k] = path.length_m[k] - paid_out[k];
    }
    compare("the angles of the joints that " + actuator.name + " crosses", paid_out, path.length_m,
            "its shaft", 1);
    if (s.tension_N.empty()) return;
    const double stiffness =
        Spring::of(actuator.tendon)
            .slope_N_per_m(Spring::of(actuator.tendon).stretch_m(actuator.tendon.pretension_N));
    for (double& x : stretch) x *= stiffness;
    compare(actuator.name + ".tension_N", stretch, s.tension_N, "its stretch", 1);
  }

  void limits(const erp::Joint& joint, const Signal& angle) {
    if (joint.type != erp::JointType::revolute || angle.empty()) return;
    const double widest = std::max({std::abs(joint.min_rad), std::abs(joint.max_rad), 0.3});
    double largest = 0;
    for (const double x : angle)
      if (!std::isnan(x)) largest = std::max(largest, std::abs(x));
    if (largest > far_off * widest)
      odd_.push_back(
          fmt::format("{}: {}.angle_rad: goes to {:.3g}, its stops are at {:g} and {:g} rad: if "
                      "these are degrees, divide by 57.29578",
                      e_.name, joint.name, largest, joint.min_rad, joint.max_rad));
  }

  const Episode& e_;
  const erp::Robot& robot_;
  Skeletal bones_;
  std::vector<std::string> odd_;
};

}  // namespace

std::vector<std::string> odd_units(const Episode& episode, const erp::Robot& robot) {
  return Check(episode, robot).run();
}

}  // namespace sim::residuals
