#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"

/// The gains of one ECU channel as messages, with the names and order of firmware/core/parameters.h.
namespace plant {

/// All gains, designed from robot.xml; the last value commits the set.
std::vector<erp::EcuParameterValue> gain_set(const erp::Robot& robot,
                                             const erp::Actuator& actuator);

/// The index of a gain by its name, e.g. `length_gain_V_per_rad`; std::nullopt for unknown names.
std::optional<std::size_t> gain_index(std::string_view name);

}  // namespace plant
