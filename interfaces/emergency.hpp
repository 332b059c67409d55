#pragma once
#include <cstdint>
#include <limits>

/// The emergency off. The plant latches a command of mode off with this priority: the actuator stays
/// off, whatever other controllers command and whether its sender still runs, until a command of mode
/// `release_mode` with this priority, or a restart of the plant. Commands of other modes with this
/// priority are processed with the next lower one.
namespace erp {

inline constexpr std::int32_t emergency_priority = std::numeric_limits<std::int32_t>::max();

/// In place of a mode: the sender gives up the actuator at once, instead of becoming stale.
inline constexpr std::uint8_t release_mode = 255;

/// In place of a mode: the reference, in m, is the change of line length since the starting pose at the
/// actuator's present position. Sets the zero of its encoder.
inline constexpr std::uint8_t set_zero_mode = 254;

}  // namespace erp
