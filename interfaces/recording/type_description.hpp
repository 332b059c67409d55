#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace recording {

/// Type of one element of a field; the primitive types of ROS 2 messages, or a structure.
enum class Kind : std::uint8_t {
  boolean,
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  string,
  structure
};

/// Multiplicity of a field.
enum class Count : std::uint8_t { one, array, sequence };

struct Field {
  std::string name;
  Kind kind = Kind::uint8;
  std::size_t structure = 0;  ///< Kind::structure: index in TypeDescription::structures
  Count count = Count::one;
  std::uint32_t size = 0;  ///< array: number of elements; sequence: maximum number, 0: unbounded
  std::uint32_t string_bound = 0;  ///< maximum number of characters, 0: unbounded
  std::string unit;                ///< "N", "rad"; empty: unknown
};

struct Structure {
  std::string name;  ///< "erp/msg/SensorFrame": package and type
  std::vector<Field> fields;
  std::size_t least_bytes = 0;  ///< minimum size without alignment; set by `check`
  const Field* find(std::string_view field) const;
};

/// A message type with all structures that it uses; the message itself is `structures[0]`.
struct TypeDescription {
  std::vector<Structure> structures;
  const Structure& root() const { return structures.front(); }
  const std::string& name() const { return root().name; }
};

std::string_view name_of(Kind kind);  ///< "float64"
std::size_t size_of(Kind kind);       ///< bytes of a primitive; 0 for string and structure

/// "erp::SensorFrame" → "erp/msg/SensorFrame"; "sensor_msgs::msg::dds_::JointState_" →
/// "sensor_msgs/msg/JointState". The modules before the type are the package.
std::string ros_name(std::string_view idl_name);

/// A valid ROS 2 field name: lower case, no underscore at the start or end, no double underscore.
/// "tension_N" → "tension_n". Foxglove rejects a schema with other names.
std::string ros_field_name(std::string_view name);

/// The type as `ros2msg` text: its fields, then `===` and `MSG: package/Type` for every structure that
/// it uses. A comment contains the original name if it was changed, and the unit if known:
/// `float64 tension_n  # tension_N [N]`. parse_ros2msg reads both.
std::string ros2msg_text(const TypeDescription& type);

/// Checks that every structure has fields with unique names and does not contain itself; sets
/// `least_bytes`. Throws std::invalid_argument with the field.
void check(TypeDescription& type);

/// Minimum size in bytes of one element of this field. The type must have passed `check`.
std::size_t least_bytes(const TypeDescription& type, const Field& field);

}  // namespace recording
