#pragma once
#include <cstdint>

/// Enumerations used in messages.
namespace erp {

/// Control mode of an actuator; defines the unit of its reference.
enum class Mode : std::uint8_t { off = 0, voltage = 1, length = 2, current = 3, force = 4 };

/// What the plant does with an actuator that has no owner.
enum class SafeAction : std::uint8_t { none = 0, hold = 1, relax = 2, damp = 3 };

/// Bits for the measurements of a sample that were taken.
namespace valid {
inline constexpr std::uint8_t voltage = 1, current = 2, shaft = 4, line = 8, tension = 16;
inline constexpr std::uint8_t all = 31;  ///< all measurements of an ECU channel
inline constexpr std::uint8_t without_zero =
    all & ~(shaft | line);                         ///< the encoder's zero is unknown
inline constexpr std::uint8_t potentiometer = 32;  ///< if the actuator has one
inline constexpr std::uint8_t joint_angle = 1;
}  // namespace valid

/// State of one ECU channel; same values as `ecu_state` in firmware/core.
enum class EcuState : std::uint8_t {
  boot = 0,
  idle = 1,
  armed = 2,
  running = 3,
  fault = 4,
  unknown = 255
};

enum class Lifecycle : std::uint8_t {
  unconfigured = 0,
  inactive = 1,
  active = 2,
  error = 3,
  finalized = 4
};
enum class Severity : std::uint8_t { info = 0, warning = 1, fault = 2 };

constexpr const char* unit_of(Mode mode) {
  switch (mode) {
    case Mode::voltage:
      return "V";
    case Mode::length:
      return "m";
    case Mode::current:
      return "A";
    case Mode::force:
      return "N";
    case Mode::off:
      break;
  }
  return "";
}

constexpr const char* name_of(Mode mode) {
  switch (mode) {
    case Mode::voltage:
      return "voltage";
    case Mode::length:
      return "length";
    case Mode::current:
      return "current";
    case Mode::force:
      return "force";
    case Mode::off:
      break;
  }
  return "off";
}

}  // namespace erp
