#pragma once
#include <cmath>
#include <numbers>
#include <string>

#include "interfaces/values.hpp"
#include "interfaces/xml/fields.hpp"

/// One test signal for one actuator, t seconds after the component began:
///
///   constant   offset
///   step       offset; from start_s on offset + amplitude
///   sine       offset + amplitude sin(2π f (t − start_s))
///   sweep      the same, f rising linearly from frequency_Hz to end_frequency_Hz in duration_s
namespace reference {

enum class Shape { constant, step, sine, sweep };

struct Signal {
  static constexpr auto element = "signal";
  xml::Place place;
  std::string actuator;
  erp::Mode mode = erp::Mode::force;
  Shape shape = Shape::constant;
  double offset = 0, amplitude = 0;    ///< in V, m, A or N, depending on `mode`
  double start_s = 0, duration_s = 0;  ///< duration 0: unlimited; the offset applies afterwards
  double frequency_Hz = 1, end_frequency_Hz = 1;

  void visit(auto& v) {
    v.required("actuator", actuator);
    v.required("mode", mode);
    v.required("shape", shape);
    v("offset", offset);
    v("amplitude", amplitude);
    v("start_s", start_s, xml::at_least_zero);
    v("duration_s", duration_s, xml::at_least_zero);
    v("frequency_Hz", frequency_Hz, xml::at_least_zero);
    v("end_frequency_Hz", end_frequency_Hz, xml::at_least_zero);
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
    const double rise = duration_s > 0 ? (end_frequency_Hz - frequency_Hz) / duration_s : 0;
    return offset +
           amplitude * std::sin(2 * std::numbers::pi * (frequency_Hz + 0.5 * rise * t) * t);
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
