#include "sim/model/effects/library.hpp"

#include <algorithm>
#include <utility>

#include "interfaces/xml/reader.hpp"
#include "interfaces/xml/words.hpp"

namespace sim::effects {
namespace {

template <std::size_t... k>
std::vector<AnyEffect> default_effects(std::index_sequence<k...>) {
  return {AnyEffect(std::in_place_index<k>)...};
}

/// Calls function(name, value, bounds, fitted) for each parameter.
template <class Function>
struct EachParameter {
  Function function;
  void operator()(const char* name, double& value, Bounds bounds) {
    function(name, value, bounds, true);
  }
  void shape(const char* name, double& value, Bounds bounds) {
    function(name, value, bounds, false);
  }
};

template <class Function>
void each_parameter(auto& effect, Function function) {
  EachParameter<Function> visitor{function};
  effect.visit(visitor);
}

/// An effect's attributes for the strict reader.
template <class E>
struct Attributes {
  E& effect;
  void visit(auto& v) {
    each_parameter(effect, [&](const char* name, double& value, Bounds bounds, bool) {
      v(name, value, xml::Range{bounds.low, bounds.high});
    });
  }
};

void add_error(const erp::Effect& effect, const std::string& what, const std::string& remedy,
               std::vector<xml::Error>& errors) {
  errors.push_back(xml::error_in(erp::Effect::element, effect.place, what, remedy));
}

std::vector<std::string> types() {
  std::vector<std::string> names;
  for (const AnyEffect& effect : library()) names.emplace_back(about(effect).type);
  return names;
}

std::optional<Placed> read(const erp::Robot& robot, const erp::Effect& source,
                           std::vector<xml::Error>& errors) {
  auto effect = neutral(source.type);
  if (!effect) {
    add_error(source, "type=" + xml::quote(source.type) + " is not an effect",
              xml::did_you_mean(source.type, types()), errors);
    return {};
  }
  const Seat seat = about(*effect).seat;
  if (const auto names = places(robot, seat); !std::ranges::count(names, source.on))
    add_error(source, "on=" + xml::quote(source.on) + " names no " + std::string(word(seat)),
              xml::did_you_mean(source.on, names), errors);
  const xml::Element element{source.place, erp::Effect::element, source.parameters, {}, {}};
  const auto fill = [&](auto& e) {
    Attributes<std::decay_t<decltype(e)>> attributes{e};
    xml::Reader::fill(attributes, element, errors);
  };
  std::visit(fill, *effect);
  return Placed{source.on, *effect};
}

}  // namespace

const std::vector<AnyEffect>& library() {
  static const auto all =
      default_effects(std::make_index_sequence<std::variant_size_v<AnyEffect>>());
  return all;
}

const About& about(const AnyEffect& effect) {
  return std::visit([](const auto& e) -> const About& { return e.about; }, effect);
}

std::optional<Sense> sense_of(const AnyEffect& effect) {
  return std::visit(
      [](const auto& e) -> std::optional<Sense> {
        if constexpr (requires { e.sense; }) return e.sense;
        else return {};
      },
      effect);
}

std::string_view word(Stage stage) {
  constexpr std::array<std::string_view, 9> names{
      "bus", "motor", "gearbox", "spindle", "tendon", "routing", "joint", "skeleton", "sensor"};
  return names[static_cast<std::size_t>(stage)];
}

std::string_view word(Seat seat) {
  constexpr std::array<std::string_view, 4> names{"actuator", "joint", "body", "robot"};
  return names[static_cast<std::size_t>(seat)];
}

std::optional<AnyEffect> neutral(std::string_view type) {
  const auto entry = std::ranges::find_if(
      library(), [&](const AnyEffect& effect) { return about(effect).type == type; });
  return entry == library().end() ? std::nullopt : std::optional(*entry);
}

std::vector<Parameter> parameters(AnyEffect& effect) {
  std::vector<Parameter> all;
  const auto add = [&](const char* name, double& value, Bounds bounds, bool fitted) {
    all.push_back({name, &value, bounds, fitted});
  };
  std::visit([&](auto& e) { each_parameter(e, add); }, effect);
  return all;
}

std::vector<std::string> places(const erp::Robot& robot, Seat seat) {
  std::vector<std::string> names;
  const auto add = [&](const auto& items) {
    for (const auto& item : items) names.push_back(item.name);
  };
  const auto add_once = [&](const std::string& name) {
    if (!std::ranges::count(names, name)) names.push_back(name);
  };
  switch (seat) {
    case Seat::actuator:
      add(robot.actuators);
      for (const erp::Drive& drive : robot.drives) add_once(drive.name);
      break;
    case Seat::joint:
      add(robot.joints());
      for (const erp::Drive& drive : robot.drives)
        if (erp::has_load_sensor(drive)) add_once(drive.name);
      break;
    case Seat::body:
      add(robot.bodies());
      for (const erp::Drive& drive : robot.drives)
        if (erp::has_load_sensor(drive)) add_once(drive.name + ".load");
      break;
    case Seat::robot:
      names.push_back(robot.name);
      break;
  }
  return names;
}

std::vector<Placed> read_effects(const erp::Robot& robot) {
  std::vector<Placed> all;
  std::vector<xml::Error> errors;
  for (const erp::Effect& source : robot.effects)
    if (auto placed = read(robot, source, errors)) all.push_back(std::move(*placed));
  xml::throw_if_any(std::move(errors));
  return all;
}

erp::Effect written(const Placed& placed) {
  erp::Effect effect{{}, std::string(about(placed.effect).type), placed.on, {}};
  AnyEffect changed = placed.effect, unchanged = *neutral(effect.type);
  const auto values = parameters(changed), defaults = parameters(unchanged);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (*values[k].value != *defaults[k].value)
      effect.parameters.push_back({{}, values[k].name, xml::write_number(*values[k].value)});
  return effect;
}

}  // namespace sim::effects
