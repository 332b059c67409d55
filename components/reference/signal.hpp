#pragma once
#include <cmath>
#include <numbers>
#include <string>

#include "interfaces/values.hpp"
#include "interfaces/xml/fields.hpp"

/// Test signal of one actuator as a function of the time t since the first frame, in s:
///
///   constant   offset
///   step       offset; from start_s on offset + amplitude
///   sine       offset + amplitude sin(2π f (t − start_s))
///   sweep      as sine, with f rising linearly from frequency_Hz to end_frequency_Hz in duration_s
namespace reference {

enum class Shape { constant, step, sine, sweep };

struct Signal {
  static constexpr auto element = "signal";
  static constexpr auto description = "Test signal for one actuator.";
  xml::Place place;
  std::string actuator;
  erp::Mode mode = erp::Mode::force;
  Shape shape = Shape::constant;
  double offset = 0, amplitude = 0;
  double start_s = 0, duration_s = 0;
  double frequency_Hz = 1, end_frequency_Hz = 1;

  void visit(auto& v) {
    v.required("actuator", actuator, "Actuator that follows the signal.");
    v.required("mode", mode,
               "Controlled variable: voltage in V, length in m, current in A or force in N.");
    v.required("shape", shape,
               "Signal: constant, step at start_s, sine, or sweep, a sine of linearly changing "
               "frequency.");
    v("offset", offset,
      "Value before, after and about which the signal changes, in the unit of the mode.");
    v("amplitude", amplitude,
      "Height of the step, amplitude of sine and sweep, in the unit of the mode.");
    v("start_s", start_s, {xml::at_least_zero, "Beginning of the signal, after the first frame."});
    v("duration_s", duration_s,
      {xml::at_least_zero, "Length of the signal, after which the offset applies; 0: unlimited."});
    v("frequency_Hz", frequency_Hz,
      {xml::at_least_zero, "Frequency of a sine; of a sweep at its beginning."});
    v("end_frequency_Hz", end_frequency_Hz,
      {xml::at_least_zero, "Frequency of a sweep at its end."});
  }

  double at(double t_s) const {
    const double t = t_s - start_s;
    if (t < 0 || (duration_s > 0 && t >= duration_s)) return offset;
    switch (shape) {
      case Shape::constant:
        return offset;
      case Shape::step:
        return offset + amplitude;
      case Shape::sine:
        return offset + amplitude * std::sin(2 * std::numbers::pi * frequency_Hz * t);
      case Shape::sweep:
        break;
    }
    // φ(t) = 2π ∫ f dt with f = f0 + (f1 − f0) t / T
    const double frequency_slope =
        duration_s > 0 ? (end_frequency_Hz - frequency_Hz) / duration_s : 0;
    return offset + amplitude * std::sin(2 * std::numbers::pi *
                                         (frequency_Hz + 0.5 * frequency_slope * t) * t);
  }
};

}  // namespace reference

template <>
struct xml::Names<reference::Shape> {
  static constexpr auto list = std::to_array<std::pair<const char*, reference::Shape>>(
      {{"constant", reference::Shape::constant},
       {"step", reference::Shape::step},
       {"sine", reference::Shape::sine},
       {"sweep", reference::Shape::sweep}});
};
template <>
struct xml::Names<erp::Mode> {
  static constexpr auto list =
      std::to_array<std::pair<const char*, erp::Mode>>({{"voltage", erp::Mode::voltage},
                                                        {"length", erp::Mode::length},
                                                        {"current", erp::Mode::current},
                                                        {"force", erp::Mode::force}});
};
