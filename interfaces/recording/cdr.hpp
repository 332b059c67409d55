#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "interfaces/recording/bytes.hpp"
#include "interfaces/recording/type_description.hpp"

/// CDR messages (XCDR1: encapsulation 00 00 big endian, 00 01 little endian) read by description.
namespace recording {

struct Value;
using Values = std::vector<Value>;

/// A structure's fields in order; `type` is lent by the TypeDescription it was decoded with.
struct Members {
  const Structure* type = nullptr;
  Values fields;
  const Value* find(std::string_view name) const;  ///< nullptr: no such field
};

/// Anything a message can hold. Integers keep their sign, floats their width.
struct Value {
  std::variant<bool, std::int64_t, std::uint64_t, float, double, std::string, Values, Members> data;

  /// The number as a double; nothing for text, arrays and structures.
  std::optional<double> number() const;
  const std::string* text() const { return std::get_if<std::string>(&data); }
  const Values* elements() const { return std::get_if<Values>(&data); }
  const Members* members() const { return std::get_if<Members>(&data); }
};

/// Decodes a message with its 4-byte encapsulation. Throws RecordingError (field, byte, what) when
/// it does not fit the type; never reads past it, never allocates more than it can fill.
/// The result lends names from `type`, which must outlive it and must have been `check`ed.
Members decode_cdr(const TypeDescription& type, ByteView message);

/// What every message of ours begins with, without decoding the rest.
struct Header {
  std::optional<std::string> robot;
  std::optional<std::int64_t> stamp_ns;
  std::optional<std::uint64_t> sequence;
};
/// Reads up to `stamp_ns` and `sequence`; stops at the first sequence or array in front of them.
Header header_of(const TypeDescription& type, ByteView message);

/// The value as text that reads back equal; text as it is; arrays and structures as JSON.
std::string to_text(const Value& value);
std::string to_json(const Members& members);

}  // namespace recording
