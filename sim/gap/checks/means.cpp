#include "sim/gap/checks/means.hpp"

#include <algorithm>
#include <utility>

#include "sim/gap/residuals/bump.hpp"

namespace sim::checks {
namespace {

constexpr double half_width_s = 0.03;  // of the window; chosen
constexpr std::size_t stride = 8;      // rows from one mean to the next; chosen

std::size_t index_of(Quantity quantity) { return static_cast<std::size_t>(quantity); }

}  // namespace

Signal& Means::operator[](const Column& c) {
  return c.quantity == Quantity::angle ? joints[c.of].angle_rad
                                       : actuators[c.of].measured[index_of(c.quantity)];
}

const Signal& Means::operator[](const Column& c) const { return const_cast<Means&>(*this)[c]; }

void Means::scale(const Column& column, double factor) {
  const auto multiply = [&](Signal& signal) {
    for (double& x : signal) x *= factor;
  };
  multiply((*this)[column]);
  if (column.quantity == Quantity::shaft)
    multiply(actuators[column.of].speed_rad_per_s),
        multiply(actuators[column.of].acceleration_rad_per_s2);
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

Means means_of(const Episode& e, std::size_t first, std::size_t end) {
  const residuals::Bump bump(half_width_s, e.period_s);
  Means means;
  std::vector<std::size_t> rows;
  for (std::size_t k = first + bump.reach(); k + bump.reach() < end; k += stride) rows.push_back(k);
  means.rows = rows.size();
  const auto downsampled = [&](const Signal& signal, auto value_at) {
    Signal values;
    for (const std::size_t k : rows)
      if (!signal.empty()) values.push_back(value_at(signal, k));
    return values;
  };
  const auto mean = [&](const Signal& s, std::size_t k) { return bump.mean(s, k); };
  const auto sample = [](const Signal& s, std::size_t k) { return s[k]; };
  for (const residuals::ActuatorSignals& s : e.actuators)
    means.actuators.push_back(
        {{downsampled(s.voltage_V, mean), downsampled(s.current_A, mean),
          downsampled(s.shaft_rad, mean), downsampled(s.tension_N, mean)},
         downsampled(s.shaft_rad, [&](const Signal& x, std::size_t k) { return bump.rate(x, k); }),
         downsampled(s.shaft_rad,
                     [&](const Signal& x, std::size_t k) { return bump.acceleration(x, k); })});
  for (const JointSignals& joint : e.joints) {
    JointSignals& j = means.joints.emplace_back();
    j.angle_rad = downsampled(joint.angle_rad, mean);
    for (std::size_t k = 0; k < 4; ++k) j.quaternion[k] = downsampled(joint.quaternion[k], sample);
  }
  return means;
}

}  // namespace sim::checks
