#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"

/// The gains of one ECU channel as messages; names and order are firmware/core/parameters.h's.
namespace plant {

/// The whole set, designed from robot.xml; the last value commits it.
std::vector<erp::EcuParameterValue> gain_set(const erp::Robot& robot,
                                             const erp::Actuator& actuator);

/// The place of a gain by its name, e.g. `length_gain_V_per_rad`; nothing when there is none.
std::optional<std::size_t> gain_index(std::string_view name);

}  // namespace plant
