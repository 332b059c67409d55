#pragma once
#include <array>
#include <string>

#include "sim/gap/residuals/episode.hpp"

/// The columns of a recording and their names.
namespace sim::residuals {

enum class Quantity { voltage, current, shaft, tension, angle };
inline constexpr std::array actuator_quantities{Quantity::voltage, Quantity::current,
                                                Quantity::shaft, Quantity::tension};

/// A measured quantity of an actuator, or the angle of a joint.
struct Column {
  Quantity quantity;
  std::size_t of;  ///< index of the actuator or joint
  bool operator==(const Column&) const = default;
};

/// Four columns for each actuator, then one for each joint. Columns that a recording lacks are
/// included.
std::vector<Column> all_columns(std::size_t actuators, std::size_t joints);

/// Example: "flexor.tension_N". For a drive (drives.hpp): the names of its control, positions and
/// torque.
std::string name_of(const Column& column, const Episode& episode, const erp::Robot& robot);

}  // namespace sim::residuals
