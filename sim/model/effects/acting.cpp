#include "sim/model/effects/acting.hpp"

#include <algorithm>
#include <array>
#include <ranges>
#include <type_traits>

#include "sim/model/effects/library.hpp"

namespace sim::effects {

struct Acting::Item {
  AnyEffect effect;
  Memory memory{};
};

Acting::Acting() = default;
Acting::Acting(const Acting&) = default;
Acting::Acting(Acting&&) noexcept = default;
Acting& Acting::operator=(const Acting&) = default;
Acting& Acting::operator=(Acting&&) noexcept = default;
Acting::~Acting() = default;

Acting::Acting(std::span<const Placed> all, const std::string& on, Seat seat) {
  for (const Placed& placed : all)
    if (placed.on == on && about(placed.effect).seat == seat) {
      items_.push_back({placed.effect, {}});
      types_ |= TypeSet(1) << placed.effect.index();
    }
  empty_ = items_.empty();
}

namespace {

/// The effects of the library that `Function` accepts, one bit per effect type.
template <class Function, class... Effects>
TypeSet accepted_by(std::type_identity<std::variant<Effects...>>) {
  constexpr std::array accepted{std::is_invocable_v<Function&, Effects&, Memory&>...};
  static_assert(accepted.size() <= TypeSet().size());
  TypeSet bits;
  for (std::size_t k = 0; k < accepted.size(); ++k) bits[k] = accepted[k];
  return bits;
}

}  // namespace

/// Calls `function(effect, memory)` for each of `items` that `function` accepts.
template <class Function>
void Acting::each(auto&& items, Function function) {
  static const TypeSet accepted = accepted_by<Function>(std::type_identity<AnyEffect>{});
  if ((accepted & types_).none()) return;
  for (Item& item : items) {
    if (!accepted[item.effect.index()]) continue;
    std::visit(
        [&](auto& effect) {
          if constexpr (std::is_invocable_v<Function&, decltype(effect), Memory&>)
            function(effect, item.memory);
        },
        item.effect);
  }
}
template <class Function>
void Acting::each(Function function) {
  each(items_, function);
}

void Acting::save(std::vector<Memory>& memories) const {
  for (const Item& item : items_) memories.push_back(item.memory);
}

void Acting::restore(std::span<const Memory>& memories) {
  for (Item& item : items_) item.memory = memories.front(), memories = memories.subspan(1);
}

double Acting::voltage_V(double volts, const ChainSample& s) {
  each(
      [&](auto& e, Memory&) requires requires { e.voltage_V(volts, s); } {
        volts = e.voltage_V(volts, s);
      });
  return volts;
}

double Acting::driver_delay_s() {
  double sum = 0;
  each(
      [&](auto& e, Memory&) requires requires { e.driver_delay_s(); } {
        sum += e.driver_delay_s();
      });
  return sum;
}

double Acting::delayed_voltage_V(double volts, const ChainSample& s) {
  each(
      [&](auto& e, Memory& m) requires requires { e.delayed_voltage_V(volts, s, m); } {
        volts = e.delayed_voltage_V(volts, s, m);
      });
  return volts;
}

double Acting::resistance_ohm(double winding_ohm, const ChainSample& s) {
  each(
      [&](auto& e, Memory& m) requires requires { e.resistance_ohm(winding_ohm, s, m); } {
        winding_ohm = e.resistance_ohm(winding_ohm, s, m);
      });
  return winding_ohm;
}

double Acting::rotor_Nm(const ChainSample& s) {
  double sum = 0;
  each(
      [&](auto& e, Memory&) requires requires { e.rotor_Nm(s); } { sum += e.rotor_Nm(s); });
  return sum;
}

double Acting::friction_Nm(int direction, const ChainSample& s) {
  double sum = 0;
  each(
      [&](auto& e, Memory&) requires requires { e.friction_Nm(direction, s); } {
        sum += e.friction_Nm(direction, s);
      });
  return sum;
}

double Acting::aged_Nm(const ChainSample& s) {
  double sum = 0;
  each(
      [&](auto& e, Memory& m) requires requires { e.aged_Nm(s, m); } { sum += e.aged_Nm(s, m); });
  return sum;
}

Sloped Acting::wound(const ChainSample& s, Sloped line) {
  each(
      [&](auto& e, Memory& m) requires requires { e.wound(s, line, m); } {
        line = e.wound(s, line, m);
      });
  return line;
}

Sloped Acting::path(const ChainSample& s, Sloped path) {
  each(
      [&](auto& e, Memory&) requires requires { e.path(s, path); } { path = e.path(s, path); });
  return path;
}

Sloped Acting::pull(const ChainSample& s) {
  Sloped sum;
  each(
      [&](auto& e, Memory& m) requires requires { e.pull(s, m); } {
        const Sloped term = e.pull(s, m);
        sum.value += term.value, sum.slope += term.slope;
      });
  return sum;
}

double Acting::motor_side_N(double far_N, const ChainSample& s) {
  each(
      [&](auto& e, Memory&) requires requires { e.motor_side_N(far_N, s); } {
        far_N = e.motor_side_N(far_N, s);
      });
  return far_N;
}

double Acting::joint_friction_Nm(double speed) {
  double sum = 0;
  each(
      [&](auto& e, Memory&) requires requires { e.joint_friction_Nm(speed); } {
        sum += e.joint_friction_Nm(speed);
      });
  return sum;
}

Sloped Acting::joint_torque(double angle_rad) {
  Sloped sum;
  each(
      [&](auto& e, Memory&) requires requires { e.joint_torque(angle_rad); } {
        const Sloped term = e.joint_torque(angle_rad);
        sum.value += term.value, sum.slope += term.slope;
      });
  return sum;
}

double Acting::sensor_shaft_rad(double angle_rad) {
  each(
      [&](auto& e, Memory& m) requires requires { e.sensor_shaft_rad(angle_rad, m); } {
        angle_rad = e.sensor_shaft_rad(angle_rad, m);
      });
  return angle_rad;
}

double Acting::play_rad() {
  double sum = 0;
  each(
      [&](auto& e, Memory&) requires requires { e.play_rad(); } { sum += e.play_rad(); });
  return sum;
}

double Acting::read(Sense sense, double value, const SensorSample& s) {
  each(
      std::views::reverse(items_),  // the inverse of the order in `undo`
      [&](auto& e, Memory& m) requires requires { e.read(value, s, m); } {
        if (e.sense == sense) value = e.read(value, s, m);
      });
  return value;
}

double Acting::undo(Sense sense, double reading, const SensorSample& s) {
  each(
      [&](auto& e, Memory& m) requires requires { e.undo(reading, s, m); } {
        if (e.sense == sense) reading = e.undo(reading, s, m);
      });
  return reading;
}

bool Acting::acts_on(Sense sense) const {
  return std::ranges::any_of(items_, [&](const Item& i) { return sense_of(i.effect) == sense; });
}

double Acting::averaged(Sense sense, const SensorSample& s) {
  double weight = 0;
  each(
      [&](auto& e, Memory&) requires requires { e.averaged(s); } {
        if (e.sense == sense) weight = std::max(weight, e.averaged(s));
      });
  return weight;
}

double Acting::command_delay_s(const Draw& draw) {
  double sum = 0;
  each(
      [&](auto& e, Memory&) requires requires { e.command_delay_s(0.0); } {
        sum += e.command_delay_s(draw());
      });
  return sum;
}

double Acting::frame_delay_s(const Draw& draw) {
  double sum = 0;
  each(
      [&](auto& e, Memory&) requires requires { e.frame_delay_s(0.0); } {
        sum += e.frame_delay_s(draw());
      });
  return sum;
}

bool Acting::loses_command(const Draw& draw) {
  bool lost = false;
  each(
      [&](auto& e, Memory&) requires requires { e.loses_command(0.0); } {
        lost |= e.loses_command(draw());
      });
  return lost;
}

}  // namespace sim::effects
