#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "interfaces/recording/bytes.hpp"
#include "interfaces/recording/type_description.hpp"

/// Decodes CDR messages (XCDR1: encapsulation 00 00 big endian, 00 01 little endian) by their type
/// description.
namespace recording {

struct Value;
using Values = std::vector<Value>;

/// A structure's fields in order; `type` points into the TypeDescription used for decoding.
struct Members {
  const Structure* type = nullptr;
  Values fields;
  const Value* find(std::string_view name) const;  ///< null: no such field
};

/// Any value in a message. Integers keep their sign, floats their width.
struct Value {
  std::variant<bool, std::int64_t, std::uint64_t, float, double, std::string, Values, Members> data;

  /// A number or bool as a double; empty for text, arrays and structures.
  std::optional<double> number() const;
  const std::string* text() const { return std::get_if<std::string>(&data); }
  const Values* elements() const { return std::get_if<Values>(&data); }
  const Members* members() const { return std::get_if<Members>(&data); }
};

/// Decodes a message, including its 4-byte encapsulation. Throws RecordingError (field, byte, what)
/// when the message does not match the type. Never reads beyond the message. A wrong length in the
/// message cannot cause a large allocation. The result points into `type`: `type` must outlive it
/// and must have passed `check`.
Members decode_cdr(const TypeDescription& type, ByteView message);

/// The fields at the beginning of every message of this project.
struct Header {
  std::optional<std::string> robot;
  std::optional<std::int64_t> stamp_ns;
  std::optional<std::uint64_t> sequence;
};
/// Decodes the fields up to `stamp_ns` and `sequence`; stops at the first sequence, array or
/// structure.
Header header_of(const TypeDescription& type, ByteView message);

/// The value as text: a number with the fewest digits that read back equal, text unchanged, arrays
/// and structures as JSON.
std::string to_text(const Value& value);
std::string to_json(const Members& members);

}  // namespace recording
