#include "sim/diagnosis/common_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sim::diagnosis {
namespace {

struct NamedSignal {
  std::string name;
  Signal* signal;
};

/// In the same order for every recording of a robot.
std::vector<NamedSignal> signals_of(Episode& e, const erp::Robot& robot) {
  std::vector<NamedSignal> all;
  for (std::size_t a = 0; a < e.actuators.size(); ++a) {
    ActuatorSignals& s = e.actuators[a];
    const std::string& name = robot.actuators[a].name;
    all.push_back({name + ".voltage_V", &s.voltage_V});
    all.push_back({name + ".current_A", &s.current_A});
    all.push_back({name + ".shaft_rad", &s.shaft_rad});
    all.push_back({name + ".tension_N", &s.tension_N});
  }
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < e.joints.size(); ++j) {
    all.push_back({joints[j].name + ".angle_rad", &e.joints[j].angle_rad});
    for (std::size_t k = 0; k < 4; ++k)
      all.push_back({joints[j].name + ".q" + "wxyz"[k], &e.joints[j].quaternion[k]});
  }
  return all;
}

bool says_nothing(const Signal& signal) {
  return std::ranges::all_of(signal, [](double x) { return std::isnan(x); });
}

}  // namespace

void keep_common(std::vector<Episode>& episodes, const erp::Robot& robot,
                 std::vector<std::string>& remarks) {
  std::vector<std::vector<NamedSignal>> of;
  for (Episode& episode : episodes) of.push_back(signals_of(episode, robot));
  for (std::size_t n = 0; !of.empty() && n < of[0].size(); ++n) {
    const auto silent = [&](const auto& signals) { return says_nothing(*signals[n].signal); };
    const auto lacks = std::ranges::find_if(of, silent);
    if (lacks == of.end()) continue;
    if (!std::ranges::all_of(of, silent))
      remarks.push_back(fmt::format("{}: lacks {}, which is left out of the other recordings too",
                                    episodes[std::size_t(lacks - of.begin())].name, of[0][n].name));
    for (const auto& signals : of) signals[n].signal->clear();
  }
}

}  // namespace sim::diagnosis
