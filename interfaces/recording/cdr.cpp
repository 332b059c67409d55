#include "interfaces/recording/cdr.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "interfaces/recording/error.hpp"

namespace recording {
namespace {

constexpr std::size_t encapsulation_bytes = 4;  // XCDR1: two bytes of format, two of options
constexpr std::size_t max_padding_bytes = 3;    // a message may end with padding to 4 bytes

class Decoder {
 public:
  Decoder(const TypeDescription& type, ByteView message) : type_(type), bytes_(message) {
    if (message.size() < encapsulation_bytes) fail("is shorter than its 4 bytes of encapsulation");
    const auto kind = std::to_integer<int>(message[0]) << 8 | std::to_integer<int>(message[1]);
    if (kind != 0 && kind != 1)
      fail("is encoded as " + std::to_string(kind) + "; only plain CDR (0, 1) can be read");
    swap_ = (kind == 0) == (std::endian::native == std::endian::little);
    position_ = encapsulation_bytes;
  }

  Members message() {
    Members members = structure(type_.root());
    if (bytes_.size() - position_ > max_padding_bytes)
      fail("has " + std::to_string(bytes_.size() - position_) + " bytes more than its type");
    return members;
  }

  Header header() {
    Header header;
    for (const Field& field : type_.root().fields) {
      if (field.count != Count::one || field.kind == Kind::structure) break;
      field_ = &field;
      const Value value = element(field);
      if (field.name == "robot" && field.kind == Kind::string) header.robot = *value.text();
      if (field.name == "stamp_ns" && field.kind == Kind::int64)
        header.stamp_ns = std::get<std::int64_t>(value.data);
      if (field.name == "sequence" && field.kind == Kind::uint64)
        header.sequence = std::get<std::uint64_t>(value.data);
      if (header.stamp_ns && header.sequence) break;
    }
    return header;
  }

 private:
  Members structure(const Structure& type) {
    Members members{&type, {}};
    members.fields.reserve(type.fields.size());
    for (const Field& field : type.fields) {
      field_ = &field;
      members.fields.push_back(field.count == Count::one ? element(field) : elements(field));
    }
    return members;
  }

  Value elements(const Field& field) {
    const bool fixed = field.count == Count::array;
    const std::uint64_t count = fixed ? field.size : primitive<std::uint32_t>();
    if (!fixed && field.size && count > field.size)
      fail("has " + std::to_string(count) + " elements, at most " + std::to_string(field.size));
    if (count > (bytes_.size() - position_) / std::max<std::size_t>(1, least_bytes(type_, field)))
      fail("declares " + std::to_string(count) + " elements, more than the message contains");
    Values values;
    values.reserve(static_cast<std::size_t>(count));
    for (std::uint64_t i = 0; i < count; ++i) values.push_back(element(field));
    return {std::move(values)};
  }

  Value element(const Field& field) {
    field_ = &field;
    switch (field.kind) {
      case Kind::boolean:
        return {boolean()};
      case Kind::int8:
        return {std::int64_t{primitive<std::int8_t>()}};
      case Kind::uint8:
        return {std::uint64_t{primitive<std::uint8_t>()}};
      case Kind::int16:
        return {std::int64_t{primitive<std::int16_t>()}};
      case Kind::uint16:
        return {std::uint64_t{primitive<std::uint16_t>()}};
      case Kind::int32:
        return {std::int64_t{primitive<std::int32_t>()}};
      case Kind::uint32:
        return {std::uint64_t{primitive<std::uint32_t>()}};
      case Kind::int64:
        return {primitive<std::int64_t>()};
      case Kind::uint64:
        return {primitive<std::uint64_t>()};
      case Kind::float32:
        return {primitive<float>()};
      case Kind::float64:
        return {primitive<double>()};
      case Kind::string:
        return {string(field)};
      case Kind::structure:
        break;
    }
    return {structure(type_.structures[field.structure])};
  }

  bool boolean() {
    const auto value = primitive<std::uint8_t>();
    if (value > 1) fail("is a bool of " + std::to_string(value));
    return value == 1;
  }

  std::string string(const Field& field) {
    const auto length = primitive<std::uint32_t>();  // includes the terminating zero
    if (length == 0) return {};  // some writers send an empty string without terminating zero
    if (length > bytes_.size() - position_) fail("is a string longer than the message");
    std::string value(text(bytes_.subspan(position_, length - 1)));
    if (bytes_[position_ + length - 1] != std::byte{0})
      fail("is a string without its closing zero");
    if (field.string_bound && value.size() > field.string_bound)
      fail("is longer than " + std::to_string(field.string_bound) + " characters");
    position_ += length;
    return value;
  }

  /// Primitives are aligned to their own size, counted from the end of the encapsulation.
  template <class T>
  T primitive() {
    const std::size_t offset = position_ - encapsulation_bytes;
    const std::size_t start =
        encapsulation_bytes + (offset + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    if (start > bytes_.size() || sizeof(T) > bytes_.size() - start) fail("is truncated");
    std::array<std::byte, sizeof(T)> raw_bytes;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(start), sizeof(T), raw_bytes.begin());
    if (swap_) std::ranges::reverse(raw_bytes);
    position_ = start + sizeof(T);
    return std::bit_cast<T>(raw_bytes);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw RecordingError(type_.name() + (field_ ? "." + field_->name : "") + ": byte " +
                         std::to_string(position_) + ": " + what +
                         "; the message does not match its schema");
  }

  const TypeDescription& type_;
  ByteView bytes_;
  std::size_t position_ = 0;
  bool swap_ = false;
  const Field* field_ = nullptr;
};

}  // namespace

const Value* Members::find(std::string_view name) const {
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (type->fields[i].name == name) return &fields[i];
  return nullptr;
}

std::optional<double> Value::number() const {
  return std::visit(
      [](const auto& value) -> std::optional<double> {
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>)
          return static_cast<double>(value);
        else return std::nullopt;
      },
      data);
}

Members decode_cdr(const TypeDescription& type, ByteView message) {
  return Decoder(type, message).message();
}

Header header_of(const TypeDescription& type, ByteView message) {
  return Decoder(type, message).header();
}

}  // namespace recording
