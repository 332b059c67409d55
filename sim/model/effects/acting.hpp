#pragma once
#include <bitset>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/model/effects/effect.hpp"

/// The effects that act on one target in each step, in the order of the chain, with their memory.
/// Each seam function applies all effects that implement it.
namespace sim::effects {

struct Placed;

/// A set of types of effects, by their index in the library.
using TypeSet = std::bitset<128>;

class Acting {
 public:
  using Draw = std::function<double()>;  ///< uniform in 0 … 1, a new value per call

  Acting();
  Acting(std::span<const Placed> all, const std::string& on, Seat seat);
  Acting(const Acting&);
  Acting(Acting&&) noexcept;
  Acting& operator=(const Acting&);
  Acting& operator=(Acting&&) noexcept;
  ~Acting();
  bool empty() const { return empty_; }

  /// Appends the memory of the effects to `memories`.
  void save(std::vector<Memory>& memories) const;
  /// Restores the memory of the effects from the front of `memories` and removes it there.
  void restore(std::span<const Memory>& memories);

  double voltage_V(double volts, const ChainSample& s);
  double driver_delay_s();
  double delayed_voltage_V(double volts, const ChainSample& s);
  double resistance_ohm(double winding_ohm, const ChainSample& s);
  double rotor_Nm(const ChainSample& s);
  double friction_Nm(int direction, const ChainSample& s);
  double aged_Nm(const ChainSample& s);
  Sloped wound(const ChainSample& s, Sloped line);
  Sloped path(const ChainSample& s, Sloped path);
  Sloped pull(const ChainSample& s);
  double motor_side_N(double far_N, const ChainSample& s);
  double joint_friction_Nm(double speed);
  Sloped joint_torque(double angle_rad);
  double sensor_shaft_rad(double angle_rad);
  double play_rad();
  /// The reading of a sensor. Of several effects, the last in the list acts on the quantity first;
  /// `undo` inverts them from the first on.
  double read(Sense sense, double value, const SensorSample& s);
  double undo(Sense sense, double reading, const SensorSample& s);
  /// Whether any effect acts on this sensor.
  bool acts_on(Sense sense) const;
  /// The largest weight of the effects on this sensor, see `averaged` in effect.hpp.
  double averaged(Sense sense, const SensorSample& s);
  double command_delay_s(const Draw& draw);
  double frame_delay_s(const Draw& draw);
  bool loses_command(const Draw& draw);

 private:
  struct Item;
  template <class Function>
  void each(auto&& items, Function function);
  template <class Function>
  void each(Function function);
  std::vector<Item> items_;
  TypeSet types_;  ///< types of `items_`
  bool empty_ = true;
};

}  // namespace sim::effects
