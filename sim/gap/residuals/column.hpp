#pragma once
#include <array>
#include <string>

#include "sim/gap/residuals/episode.hpp"

/// A column of a recording, and what it is called there.
namespace sim::residuals {

enum class Quantity { voltage, current, shaft, tension, angle };
inline constexpr std::array actuator_quantities{Quantity::voltage, Quantity::current,
                                                Quantity::shaft, Quantity::tension};

/// What is measured of an actuator, or the angle of a joint.
struct Column {
  Quantity quantity;
  std::size_t of;  ///< which actuator, which joint
  bool operator==(const Column&) const = default;
};

/// Four of each actuator, then one of each joint; also those that a recording lacks.
std::vector<Column> all_columns(std::size_t actuators, std::size_t joints);

/// "flexor.tension_N"; of a drive (drives.hpp), what its control, its ends and its torque are called.
std::string name_of(const Column& column, const Episode& episode, const erp::Robot& robot);

}  // namespace sim::residuals
