#include "components/node/type_schema.hpp"

#include <dds/ddsi/ddsi_xqos.h>
// The headers below use definitions of ddsi_xqos.h.
#include <dds/ddsi/ddsi_typelib.h>
#include <dds/ddsi/ddsi_xt_impl.h>

#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace node {
namespace {

using recording::Count;
using recording::Field;
using recording::Kind;
using TypeId = DDS_XTypes_TypeIdentifier;
using TypeObject = DDS_XTypes_CompleteTypeObject;

struct FreeTypemap {
  void operator()(ddsi_typemap_t* map) const { ddsi_typemap_fini(map), dds_free(map); }
};
struct FreeTypeinfo {
  void operator()(ddsi_typeinfo_t* info) const { ddsi_typeinfo_fini(info), dds_free(info); }
};

ddsi_sertype_cdr_data serialized(const dds_type_meta_ser& meta) {
  return {meta.sz, const_cast<std::uint8_t*>(meta.data)};
}

std::optional<Kind> primitive(std::uint8_t kind) {
  switch (kind) {
    case DDS_XTypes_TK_BOOLEAN:
      return Kind::boolean;
    case DDS_XTypes_TK_BYTE:
      return Kind::uint8;
    case DDS_XTypes_TK_CHAR8:
      return Kind::uint8;
    case DDS_XTypes_TK_INT16:
      return Kind::int16;
    case DDS_XTypes_TK_INT32:
      return Kind::int32;
    case DDS_XTypes_TK_INT64:
      return Kind::int64;
    case DDS_XTypes_TK_UINT16:
      return Kind::uint16;
    case DDS_XTypes_TK_UINT32:
      return Kind::uint32;
    case DDS_XTypes_TK_UINT64:
      return Kind::uint64;
    case DDS_XTypes_TK_FLOAT32:
      return Kind::float32;
    case DDS_XTypes_TK_FLOAT64:
      return Kind::float64;
    default:
      return std::nullopt;
  }
}

/// Enums are serialized in 1, 2 or 4 bytes, bitmasks in 1, 2, 4 or 8.
Kind unsigned_of(unsigned bits) {
  return bits <= 8    ? Kind::uint8
         : bits <= 16 ? Kind::uint16
         : bits <= 32 ? Kind::uint32
                      : Kind::uint64;
}

class Describer {
 public:
  explicit Describer(const dds_topic_descriptor_t& type) : name_(type.m_typename) {
    if (!type.type_mapping.data || !type.type_mapping.sz)
      throw std::invalid_argument(
          name_ + ": the descriptor has no type information; compile its IDL without -t");
    const auto mapping = serialized(type.type_mapping),
               information = serialized(type.type_information);
    map_.reset(ddsi_typemap_deser(&mapping));
    info_.reset(ddsi_typeinfo_deser(&information));
    if (!map_ || !info_) throw std::invalid_argument(name_ + ": the type information is damaged");
  }

  recording::TypeDescription describe() {
    structure(info_->x.complete.typeid_with_size.type_id);
    recording::check(type_);
    return std::move(type_);
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const {
    throw std::invalid_argument(name_ + ": " + place_ + reason +
                                ", which a ROS 2 message cannot represent; record it as IDL alone");
  }

  const TypeObject& object(const TypeId& id) const {
    const auto& pairs = map_->x.identifier_object_pair_complete;
    for (std::uint32_t i = 0; i < pairs._length; ++i) {
      const auto& pair = pairs._buffer[i];
      if (id._d == DDS_XTypes_EK_COMPLETE && pair.type_identifier._d == id._d &&
          std::memcmp(pair.type_identifier._u.equivalence_hash, id._u.equivalence_hash,
                      sizeof(id._u.equivalence_hash)) == 0)
        return pair.type_object._u.complete;
    }
    throw std::invalid_argument(name_ + ": " + place_ + "has a type without description");
  }

  /// Adds the structure `id` if it is new; returns its index.
  std::size_t structure(const TypeId& id) {
    const TypeObject& type_object = object(id);
    if (type_object._d != DDS_XTypes_TK_STRUCTURE) refuse("is not a struct");
    const auto& from = type_object._u.struct_type;
    const auto [entry, is_new] = indices_.try_emplace(&type_object, type_.structures.size());
    if (!is_new) return entry->second;
    const std::size_t index = entry->second;
    type_.structures.push_back({recording::ros_name(from.header.detail.type_name), {}});
    place_ = std::string(from.header.detail.type_name) + " ";
    if (!(from.struct_flags & DDS_XTypes_IS_FINAL)) refuse("is not @final");
    std::vector<Field> fields;
    if (from.header.base_type._d != DDS_XTypes_TK_NONE) {
      const std::size_t base = structure(from.header.base_type);
      fields = type_.structures[base].fields;  // a base's members come first
    }
    for (std::uint32_t i = 0; i < from.member_seq._length; ++i)
      fields.push_back(member(from.member_seq._buffer[i], from.header.detail.type_name));
    type_.structures[index].fields = std::move(fields);
    return index;
  }

  Field member(const DDS_XTypes_CompleteStructMember& from, const char* owner) {
    place_ = std::string(owner) + "." + from.detail.name + " ";
    if (from.common.member_flags & (DDS_XTypes_IS_OPTIONAL | DDS_XTypes_IS_EXTERNAL))
      refuse("is optional or external");
    Field field;
    field.name = from.detail.name;
    if (from.detail.ann_builtin && from.detail.ann_builtin->unit)
      field.unit = from.detail.ann_builtin->unit;
    describe_type(from.common.member_type_id, field);
    return field;
  }

  void set_count(Field& field, Count count, std::uint32_t size) {
    if (field.count == Count::array && count == Count::array) {
      field.size *= size;
      return;
    }
    if (field.count != Count::one) refuse("nests sequences or arrays");
    field.count = count;
    field.size = size;
  }
  template <class Bounds>
  void array(Field& field, const Bounds& bounds) {
    for (std::uint32_t i = 0; i < bounds._length; ++i)
      set_count(field, Count::array, bounds._buffer[i]);
  }
  void string(Field& field, std::uint32_t bound) {
    field.kind = Kind::string;
    field.string_bound = bound;
  }

  void describe_type(const TypeId& id, Field& field) {
    if (const auto kind = primitive(id._d)) {
      field.kind = *kind;
      return;
    }
    switch (id._d) {
      case DDS_XTypes_TI_STRING8_SMALL:
        return string(field, id._u.string_sdefn.bound);
      case DDS_XTypes_TI_STRING8_LARGE:
        return string(field, id._u.string_ldefn.bound);
      case DDS_XTypes_TI_PLAIN_SEQUENCE_SMALL:
        set_count(field, Count::sequence, id._u.seq_sdefn.bound);
        return describe_type(*id._u.seq_sdefn.element_identifier, field);
      case DDS_XTypes_TI_PLAIN_SEQUENCE_LARGE:
        set_count(field, Count::sequence, id._u.seq_ldefn.bound);
        return describe_type(*id._u.seq_ldefn.element_identifier, field);
      case DDS_XTypes_TI_PLAIN_ARRAY_SMALL:
        array(field, id._u.array_sdefn.array_bound_seq);
        return describe_type(*id._u.array_sdefn.element_identifier, field);
      case DDS_XTypes_TI_PLAIN_ARRAY_LARGE:
        array(field, id._u.array_ldefn.array_bound_seq);
        return describe_type(*id._u.array_ldefn.element_identifier, field);
      case DDS_XTypes_EK_COMPLETE:
        return take_object(id, field);
      default:
        refuse("is a map, a wide string or a recursive type");
    }
  }

  void take_object(const TypeId& id, Field& field) {
    const TypeObject& type_object = object(id);
    switch (type_object._d) {
      case DDS_XTypes_TK_STRUCTURE:
        field.kind = Kind::structure;
        field.structure = structure(id);
        return;
      case DDS_XTypes_TK_ALIAS:
        return describe_type(type_object._u.alias_type.body.common.related_type, field);
      case DDS_XTypes_TK_ENUM:
        field.kind = unsigned_of(type_object._u.enumerated_type.header.common.bit_bound);
        return;
      case DDS_XTypes_TK_BITMASK:
        field.kind = unsigned_of(type_object._u.bitmask_type.header.common.bit_bound);
        return;
      case DDS_XTypes_TK_SEQUENCE:
        set_count(field, Count::sequence, type_object._u.sequence_type.header.common.bound);
        return describe_type(type_object._u.sequence_type.element.common.type, field);
      case DDS_XTypes_TK_ARRAY:
        array(field, type_object._u.array_type.header.common.bound_seq);
        return describe_type(type_object._u.array_type.element.common.type, field);
      default:
        refuse("is a union, a bitset or a map");
    }
  }

  std::string name_, place_;
  std::unique_ptr<ddsi_typemap_t, FreeTypemap> map_;
  std::unique_ptr<ddsi_typeinfo_t, FreeTypeinfo> info_;
  recording::TypeDescription type_;
  std::map<const TypeObject*, std::size_t> indices_;
};

}  // namespace

recording::TypeDescription describe(const dds_topic_descriptor_t& type) {
  return Describer(type).describe();
}

}  // namespace node
