#pragma once
#include "interfaces/topics.hpp"
#include "interfaces/values.hpp"
#include "interfaces/xml/fields.hpp"

/// Controls every tendon to one tension:  F_cmd = F_ref + k (F_ref − F).
class @Class@ {
 public:
  struct Params {
    double tension_N = 5.0;  // F_ref
    double gain = 0.0;       // k, dimensionless
    void visit(auto& v) { v("tension_N", tension_N, xml::at_least_zero), v("gain", gain); }
  };

  explicit @Class@(Params params) : p_(params) {}

  erp::ActuatorCommand step(const erp::SensorFrame& frame, double /*dt_s*/) {
    erp::ActuatorCommand command;
    for (const auto& sample : erp::samples(frame.actuators)) {
      auto& desired = erp::append(command.actuators, erp::ActuatorReference{});
      erp::assign(desired.name, sample.name);
      desired.mode = static_cast<std::uint8_t>(erp::Mode::force);
      desired.reference = p_.tension_N + p_.gain * (p_.tension_N - sample.tension_N);
    }
    return command;
  }

 private:
  Params p_;
};
