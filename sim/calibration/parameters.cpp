#include "sim/calibration/parameters.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/recording/csv.hpp"
#include "interfaces/xml/errors.hpp"

namespace sim::calibration {
namespace {

/// A tendon's first or last point.
erp::Attach* end_of(erp::Tendon& tendon, bool last) {
  return std::get_if<erp::Attach>(last ? &tendon.path.back() : &tendon.path.front());
}

int count(Quantity what) { return what == Quantity::attachments ? 6 : 1; }

bool clash(const std::vector<Parameter>& list, std::size_t actuator, Quantity what) {
  return std::ranges::any_of(
      list, [&](const Parameter& p) { return p.actuator == actuator && p.what == what; });
}

}  // namespace

Parameters::Parameters(erp::Robot robot, const Choice& choice) : robot_(std::move(robot)) {
  for (const Vary& vary : choice.list) choose(vary);
}

void Parameters::choose(const Vary& vary) {
  bool found = false;
  for (std::size_t a = 0; a < robot_.actuators.size(); ++a) {
    if (vary.on != "*" && vary.on != robot_.actuators[a].name) continue;
    found = true;
    if (clash(list_, a, vary.what))
      throw xml::Errors(
          {{vary.place, "this is chosen twice for actuator \"" + robot_.actuators[a].name + "\"",
            "leave one <vary> of it"}});
    for (int axis = 0; axis < count(vary.what); ++axis)
      list_.push_back({a, vary.what, axis, vary.spread});
  }
  if (!found)
    throw xml::Errors(
        {{vary.place, "robot \"" + robot_.name + "\" has no actuator \"" + vary.on + "\"",
          "name one of its actuators, or \"*\""}});
}

std::string Parameters::name_of(const Parameter& p) const {
  const std::string& muscle = robot_.actuators[p.actuator].name;
  switch (p.what) {
    case Quantity::attachments:
      return muscle + (p.axis < 3 ? " A " : " B ") + "xyz"[p.axis % 3];
    case Quantity::length:
      return muscle + " length";
    case Quantity::stiffness:
      return muscle + " stiffness";
    case Quantity::radius:
      break;
  }
  return muscle + " radius";
}

Candidate Parameters::at(const Eigen::VectorXd& x) const {
  Candidate candidate{robot_, std::vector<double>(robot_.actuators.size())};
  for (std::size_t k = 0; k < list_.size(); ++k) {
    const Parameter& p = list_[k];
    const double off = p.spread * x[static_cast<Eigen::Index>(k)];
    erp::Actuator& actuator = candidate.robot.actuators[p.actuator];
    if (p.what == Quantity::length) candidate.longer_m[p.actuator] = off;
    if (p.what == Quantity::stiffness) actuator.tendon.stiffness_N_per_m *= std::exp(off);
    if (p.what == Quantity::radius) actuator.spindle.radius_m *= std::exp(off);
    if (p.what == Quantity::attachments)
      end_of(actuator.tendon, p.axis >= 3)->at_m[static_cast<std::size_t>(p.axis % 3)] += off;
  }
  return candidate;
}

erp::Robot Parameters::robot_at(const Eigen::VectorXd& x) const {
  Candidate candidate = at(x);
  for (std::size_t a = 0; a < candidate.longer_m.size(); ++a)
    if (candidate.longer_m[a] != 0)
      candidate.robot.effects.push_back(
          {{},
           "tendon_length_offset",
           candidate.robot.actuators[a].name,
           {{{}, "length_m", recording::csv_number(candidate.longer_m[a])}}});
  return candidate.robot;
}

}  // namespace sim::calibration
