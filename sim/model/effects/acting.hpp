#pragma once
#include <bitset>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/model/effects/effect.hpp"

/// Effects at work: those on one thing, in the order of the chain, with what they remember. Each
/// seam goes through all that have it.
namespace sim::effects {

struct Placed;

/// A set of types of effects, by their index in the library.
using Types = std::bitset<128>;

class Acting {
 public:
  using Draw = std::function<double()>;  ///< uniform in 0 … 1, anew for each

  Acting();
  Acting(std::span<const Placed> all, const std::string& on, Seat seat);
  Acting(const Acting&);
  Acting(Acting&&) noexcept;
  Acting& operator=(const Acting&);
  Acting& operator=(Acting&&) noexcept;
  ~Acting();
  bool empty() const { return empty_; }

  /// What they remember, to be saved and restored.
  void save(std::vector<Memory>& memories) const;
  /// Takes its own from the front of the rest.
  void restore(std::span<const Memory>& memories);

  double voltage_V(double volts, const ChainSample& s);
  double driver_delay_s();
  double late_voltage_V(double volts, const ChainSample& s);
  double resistance_ohm(double ohm, const ChainSample& s);
  double rotor_Nm(const ChainSample& s);
  double friction_Nm(int direction, const ChainSample& s);
  double aged_Nm(const ChainSample& s);
  Sloped wound(const ChainSample& s, Sloped line);
  Sloped path(const ChainSample& s, Sloped path);
  Sloped pull(const ChainSample& s);
  double motor_side_N(double far_N, const ChainSample& s);
  double joint_friction_Nm(double speed);
  Sloped joint_torque(double angle_rad);
  double bearing_rad(double angle_rad);
  double looseness_rad();
  /// What a sensor says. Of several effects on it the last meets the quantity first; `undo` takes them
  /// away from the first on.
  double read(Sense sense, double value, const SensorSample& s);
  double undo(Sense sense, double said, const SensorSample& s);
  /// Whether any acts on that sensor.
  bool reaches(Sense sense) const;
  double averaged(Sense sense, const SensorSample& s);
  double command_delay_s(const Draw& draw);
  double frame_delay_s(const Draw& draw);
  bool loses_command(const Draw& draw);

 private:
  struct Item;
  template <class Use>
  void each(auto&& items, Use use);
  template <class Use>
  void each(Use use);
  std::vector<Item> items_;
  Types types_;  ///< that are among them
  bool empty_ = true;
};

}  // namespace sim::effects
