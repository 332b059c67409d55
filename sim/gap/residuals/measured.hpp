#pragma once
#include <string>
#include <type_traits>
#include <vector>

#include "interfaces/recording/columns.hpp"
#include "sim/gap/residuals/column.hpp"

/// The measured signals of a recording, with the names and units of their columns.
namespace sim::residuals {

template <class E>
struct Measured {
  std::string column, unit;
  std::conditional_t<std::is_const_v<E>, const Signal, Signal>* signal;
};

/// All measured signals, including empty ones, in the same order for every recording of a robot. E:
/// Episode or const Episode.
template <class E>
std::vector<Measured<E>> measured(E& e, const erp::Robot& robot) {
  std::vector<Measured<E>> signals;
  for (std::size_t a = 0; a < e.actuators.size(); ++a) {
    auto& s = e.actuators[a];
    const auto add = [&](Quantity quantity, const char* unit, auto& signal) {
      signals.push_back({name_of({quantity, a}, e, robot), unit, &signal});
    };
    add(Quantity::voltage, "V", s.voltage_V), add(Quantity::current, "A", s.current_A);
    add(Quantity::shaft, "rad", s.shaft_rad), add(Quantity::tension, "N", s.tension_N);
  }
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < e.joints.size(); ++j) {
    signals.push_back({name_of({Quantity::angle, j}, e, robot), "rad", &e.joints[j].angle_rad});
    for (std::size_t k = 0; k < 4; ++k)
      signals.push_back(
          {joints[j].name + "." + recording::quaternion_parts[k], "", &e.joints[j].quaternion[k]});
  }
  return signals;
}

}  // namespace sim::residuals
