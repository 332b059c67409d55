#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace recording {

/// What one field holds; the primitive types of ROS 2 messages.
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

/// How often a field holds it.
enum class Count : std::uint8_t { one, array, sequence };

struct Field {
  std::string name;
  Kind kind = Kind::uint8;
  std::size_t structure = 0;  ///< Kind::structure: its place in TypeDescription::structures
  Count count = Count::one;
  std::uint32_t size = 0;          ///< array: elements; sequence: at most so many, 0: any number
  std::uint32_t string_bound = 0;  ///< characters at most, 0: any number
  std::string unit;                ///< "N", "rad"; empty when not said
};

struct Structure {
  std::string name;  ///< "erp/msg/SensorFrame": package and type
  std::vector<Field> fields;
  std::size_t least_bytes = 0;  ///< the fewest bytes it takes, alignment left out; set by `check`
  const Field* find(std::string_view field) const;
};

/// A message type with everything it is made of; the message itself is `structures[0]`.
struct TypeDescription {
  std::vector<Structure> structures;
  const Structure& root() const { return structures.front(); }
  const std::string& name() const { return root().name; }
};

std::string_view name_of(Kind kind);  ///< "float64"
std::size_t size_of(Kind kind);       ///< bytes of a primitive; of string and structure, 0

/// "erp::SensorFrame" or "sensor_msgs::msg::dds_::JointState_" as "erp/msg/SensorFrame": the first
/// modules are the package.
std::string ros_name(std::string_view idl_name);

/// A field's name as ROS 2 allows it: lower case, single underscores inside only. "tension_N" →
/// "tension_n"; Foxglove refuses a schema with any other name.
std::string ros_field_name(std::string_view name);

/// The type as `ros2msg` text: its fields, then `===` and `MSG: package/Type` for every structure
/// it needs. Where a name had to change or a unit is known, a comment says so, and parse_ros2msg
/// finds them there: `float64 tension_n  # tension_N [N]`.
std::string ros2msg_text(const TypeDescription& type);

/// Checks that every structure has fields, none of them twice, and holds itself nowhere; sets
/// `least_bytes`. Throws std::invalid_argument naming the field.
void check(TypeDescription& type);

/// The fewest bytes that one element of this field takes. The type is `check`ed.
std::size_t least_bytes(const TypeDescription& type, const Field& field);

}  // namespace recording
