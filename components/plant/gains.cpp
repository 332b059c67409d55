#include "components/plant/gains.hpp"

#include <array>

#include "firmware/core/parameters.h"
#include "sim/control/gain_design.hpp"

namespace plant {

std::vector<erp::EcuParameterValue> gain_set(const erp::Robot& robot,
                                             const erp::Actuator& actuator) {
  const auto designed = sim::design_parameters(robot, actuator, {});
  std::vector<erp::EcuParameterValue> values;
  for (std::size_t i = 0; i < designed.size(); ++i)
    values.push_back({static_cast<std::uint8_t>(actuator.ecu),
                      static_cast<std::uint8_t>(actuator.channel), static_cast<std::uint8_t>(i),
                      i + 1 == designed.size(), designed[i]});
  return values;
}

std::optional<std::size_t> gain_index(std::string_view name) {
#define ERP_GAIN_NAME(id, text) std::string_view(#text),
  constexpr std::array names{ECU_PARAMETERS(ERP_GAIN_NAME)};
#undef ERP_GAIN_NAME
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return i;
  return std::nullopt;
}

}  // namespace plant
