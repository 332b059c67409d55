#include "sim/gap/checks/means.hpp"

#include <algorithm>
#include <utility>

#include "sim/gap/residuals/bump.hpp"

namespace sim::checks {
namespace {

constexpr double half_width_s = 0.03;
constexpr std::size_t stride = 8;  // rows from one mean to the next

std::size_t index_of(Quantity quantity) { return static_cast<std::size_t>(quantity); }

}  // namespace

Signal& Means::operator[](const Column& c) {
  return c.quantity == Quantity::angle ? joints[c.of].angle_rad
                                       : actuators[c.of].measured[index_of(c.quantity)];
}

const Signal& Means::operator[](const Column& c) const { return const_cast<Means&>(*this)[c]; }

void Means::scale(const Column& column, double factor) {
  const auto by = [&](Signal& signal) {
    for (double& x : signal) x *= factor;
  };
  by((*this)[column]);
  if (column.quantity == Quantity::shaft)
    by(actuators[column.of].speed_rad_per_s), by(actuators[column.of].acceleration_rad_per_s2);
}

void Means::exchange(const Column& one, const Column& other) {
  std::swap((*this)[one], (*this)[other]);
  if (one.quantity != Quantity::shaft) return;
  Actuator &a = actuators[one.of], &b = actuators[other.of];
  std::swap(a.speed_rad_per_s, b.speed_rad_per_s);
  std::swap(a.acceleration_rad_per_s2, b.acceleration_rad_per_s2);
}

void Means::remove(const Column& column) {
  (*this)[column].clear();
  if (column.quantity != Quantity::shaft) return;
  actuators[column.of].speed_rad_per_s.clear();
  actuators[column.of].acceleration_rad_per_s2.clear();
}

Means means_of(const Episode& e, std::size_t from, std::size_t until) {
  const residuals::Bump bump(half_width_s, e.period_s);
  Means means;
  std::vector<std::size_t> rows;
  for (std::size_t k = from + bump.reach(); k + bump.reach() < until; k += stride)
    rows.push_back(k);
  means.rows = rows.size();
  const auto each_row = [&](const Signal& signal, auto value_at) {
    Signal all;
    for (const std::size_t k : rows)
      if (!signal.empty()) all.push_back(value_at(signal, k));
    return all;
  };
  const auto mean = [&](const Signal& s, std::size_t k) { return bump.mean(s, k); };
  const auto here = [](const Signal& s, std::size_t k) { return s[k]; };
  for (const residuals::ActuatorSignals& s : e.actuators)
    means.actuators.push_back(
        {{each_row(s.voltage_V, mean), each_row(s.current_A, mean), each_row(s.shaft_rad, mean),
          each_row(s.tension_N, mean)},
         each_row(s.shaft_rad, [&](const Signal& x, std::size_t k) { return bump.rate(x, k); }),
         each_row(s.shaft_rad,
                  [&](const Signal& x, std::size_t k) { return bump.acceleration(x, k); })});
  for (const JointSignals& joint : e.joints) {
    JointSignals& j = means.joints.emplace_back();
    j.angle_rad = each_row(joint.angle_rad, mean);
    for (std::size_t k = 0; k < 4; ++k) j.quaternion[k] = each_row(joint.quaternion[k], here);
  }
  return means;
}

}  // namespace sim::checks
