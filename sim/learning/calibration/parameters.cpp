#include "sim/learning/calibration/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "interfaces/xml/errors.hpp"
#include "sim/model/effects/library.hpp"

namespace sim::calibration {
namespace {

/// A tendon's first or last point.
erp::Attach* end_of(erp::Tendon& tendon, bool is_last) {
  return std::get_if<erp::Attach>(is_last ? &tendon.path.back() : &tendon.path.front());
}

/// Length offsets by actuator; their effects are removed from the robot.
std::vector<double> take_length_offsets_m(erp::Robot& robot) {
  std::vector<double> length_offset_m(robot.actuators.size());
  const auto all = effects::read_effects(robot);
  robot.effects.clear();
  for (const effects::Placed& placed : all)
    if (const auto* offset = std::get_if<effects::TendonLengthOffset>(&placed.effect))
      for (std::size_t a = 0; a < length_offset_m.size(); ++a)
        length_offset_m[a] += robot.actuators[a].name == placed.on ? offset->length_m : 0;
    else robot.effects.push_back(effects::written(placed));
  return length_offset_m;
}

/// Upper bound of `tendon_length_offset`.
double largest_offset_m() {
  auto effect = *effects::neutral(effects::TendonLengthOffset::about.type);
  return effects::parameters(effect).front().bounds.high;
}

int count(Quantity what) { return what == Quantity::attachments ? 6 : 1; }

bool is_chosen(const std::vector<Parameter>& list, std::size_t actuator, Quantity what) {
  return std::ranges::any_of(
      list, [&](const Parameter& p) { return p.actuator == actuator && p.what == what; });
}

}  // namespace

Parameters::Parameters(erp::Robot robot, const Choice& choice)
    : robot_(std::move(robot)), length_offset_m_(take_length_offsets_m(robot_)) {
  for (const Vary& vary : choice.list) choose(vary);
}

void Parameters::choose(const Vary& vary) {
  bool has_actuator = false;
  for (std::size_t a = 0; a < robot_.actuators.size(); ++a) {
    if (vary.on != "*" && vary.on != robot_.actuators[a].name) continue;
    has_actuator = true;
    if (is_chosen(list_, a, vary.what))
      throw xml::Errors(
          {{vary.place,
            "this quantity is chosen twice for actuator \"" + robot_.actuators[a].name + "\"",
            "keep one <vary> for it"}});
    for (int axis = 0; axis < count(vary.what); ++axis)
      list_.push_back({a, vary.what, axis, vary.spread});
  }
  if (!has_actuator)
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
  Candidate candidate{robot_, length_offset_m_};
  for (std::size_t k = 0; k < list_.size(); ++k) {
    const Parameter& p = list_[k];
    const double offset = p.spread * x[static_cast<Eigen::Index>(k)];
    erp::Actuator& actuator = candidate.robot.actuators[p.actuator];
    if (p.what == Quantity::length) candidate.length_offset_m[p.actuator] += offset;
    if (p.what == Quantity::stiffness) actuator.tendon.stiffness_N_per_m *= std::exp(offset);
    if (p.what == Quantity::radius) actuator.spindle.radius_m *= std::exp(offset);
    if (p.what == Quantity::attachments)
      end_of(actuator.tendon, p.axis >= 3)->at_m[static_cast<std::size_t>(p.axis % 3)] += offset;
  }
  static const double max_offset_m = largest_offset_m();
  for (std::size_t a = 0; a < candidate.length_offset_m.size(); ++a)
    if (std::abs(candidate.length_offset_m[a]) > max_offset_m)
      throw std::invalid_argument(
          "actuator \"" + robot_.actuators[a].name +
          "\": the length offset exceeds the limit of the effect tendon_length_offset");
  return candidate;
}

erp::Robot Parameters::robot_at(const Eigen::VectorXd& x) const {
  Candidate candidate = at(x);
  for (std::size_t a = 0; a < candidate.length_offset_m.size(); ++a)
    if (candidate.length_offset_m[a] != 0)
      candidate.robot.effects.push_back(
          effects::written({candidate.robot.actuators[a].name,
                            effects::TendonLengthOffset{candidate.length_offset_m[a]}}));
  return candidate.robot;
}

}  // namespace sim::calibration
