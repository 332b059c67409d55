#include <algorithm>
#include <stdexcept>

#include "interfaces/robot/mass.hpp"
#include "sim/gap/blind/effect_kinds.hpp"
#include "sim/gap/blind/joint_load.hpp"

namespace sim::blind {
namespace {

constexpr std::pair<Kind, const char*> kind_names[] = {
    {Kind::single, "single"},   {Kind::null, "null"},         {Kind::pair, "pair"},
    {Kind::outside, "outside"}, {Kind::withheld, "withheld"}, {Kind::many, "many"}};

std::size_t random_index(std::size_t count, Random& random) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

/// Index of a random revolute joint. Effects on joints need an angle.
std::size_t random_joint(const erp::Robot& robot, Random& random) {
  const auto joints = robot.joints();
  std::vector<std::size_t> revolute;
  for (std::size_t k = 0; k < joints.size(); ++k)
    if (joints[k].type == erp::JointType::revolute) revolute.push_back(k);
  if (revolute.empty()) throw std::invalid_argument(robot.name + ": no revolute joint");
  return revolute[random_index(revolute.size(), random)];
}

Hidden hide(const EffectKind& kind, const erp::Robot& robot, HiddenEffects& hidden_effects,
            Random& random) {
  constexpr double hinge_rig_Nm = 3.75;  // joint_load_Nm of configs/hinge_rig
  Place place{hidden_effects,
              robot,
              random_index(robot.actuators.size(), random),
              random_joint(robot, random),
              {}};
  place.relative_load = joint_load_Nm(robot, place.joint) / hinge_rig_Nm;
  std::vector<std::string> bodies_with_mass;
  for (const erp::Body& body : robot.bodies())
    if (erp::mass_of(body).mass_kg > 0) bodies_with_mass.push_back(body.name);
  place.body = bodies_with_mass.at(random_index(bodies_with_mass.size(), random));
  if (kind.on == EffectKind::link) place.body = robot.joints()[place.joint].child;
  const std::string on[] = {robot.actuators[place.channel].name, robot.joints()[place.joint].name,
                            place.body, place.body, robot.name};
  return {kind.type, kind.stage, on[kind.on], kind.draw(place, random)};
}

std::vector<const EffectKind*> kinds_of(std::span<const EffectKind> all,
                                        const std::vector<std::string>& only) {
  std::vector<const EffectKind*> kinds;
  for (const EffectKind& kind : all)
    if (only.empty() || std::ranges::count(only, kind.type)) kinds.push_back(&kind);
  for (const std::string& type : only)
    if (std::ranges::none_of(all, [&](const EffectKind& kind) { return kind.type == type; }))
      throw std::invalid_argument("\"" + type + "\" is not an effect that this kind of case hides");
  return kinds;
}

}  // namespace

const char* word(Kind kind) {
  return std::ranges::find(kind_names, kind, &std::pair<Kind, const char*>::first)->second;
}

Kind kind_of(const std::string& word) {
  for (const auto& [kind, name] : kind_names)
    if (word == name) return kind;
  throw std::invalid_argument("kind \"" + word +
                              "\" is not one of single, null, pair, outside, withheld, many");
}

Case draw_case(const erp::Robot& robot, Kind kind, std::uint64_t seed,
               const std::vector<std::string>& only,
               const std::function<bool(const HiddenEffects&)>& is_visible) {
  if (robot.actuators.empty()) throw std::invalid_argument(robot.name + ": no actuator");
  Random random(seed * 0x9e3779b97f4a7c15u + 0x1234567u);  // spreads successive seeds over all bits
  Case blind{seed, kind, {}, {}, {}};
  blind.hidden_effects.channels.resize(robot.actuators.size());
  blind.hidden_effects.joints.resize(robot.joints().size());
  const HiddenEffects no_effects = blind.hidden_effects;
  constexpr int max_rejected_draws = 50;
  const auto hide_one = [&](std::span<const EffectKind> all) -> const EffectKind& {
    const auto kinds = kinds_of(all, only);
    while (true) {
      const EffectKind& chosen = *kinds[random_index(kinds.size(), random)];
      Random same_numbers = random;
      HiddenEffects single_effect = no_effects;
      const Hidden hidden = hide(chosen, robot, single_effect, random);
      if (is_visible && blind.rejected_draws < max_rejected_draws && !is_visible(single_effect)) {
        ++blind.rejected_draws;
        continue;
      }
      hide(chosen, robot, blind.hidden_effects, same_numbers);
      blind.hidden.push_back(hidden);
      return chosen;
    }
  };
  if (kind == Kind::single) hide_one(in_library());
  if (kind == Kind::outside) hide_one(outside_library());
  if (kind == Kind::pair)
    while (blind.hidden.size() < 2) {
      hide_one(in_library());
      if (blind.hidden.size() == 2 && blind.hidden[0].type == blind.hidden[1].type &&
          blind.hidden[0].on == blind.hidden[1].on)
        blind.hidden.pop_back();
    }
  if (kind == Kind::many) blind.built = many_off(robot, seed, blind.hidden_effects);
  if (kind == Kind::withheld) {
    const EffectKind& chosen = hide_one(in_library());
    blind.withhold.emplace_back(chosen.type);
    for (const char* other : chosen.indistinguishable) blind.withhold.emplace_back(other);
  }
  return blind;
}

}  // namespace sim::blind
