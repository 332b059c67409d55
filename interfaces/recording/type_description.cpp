#include "interfaces/recording/type_description.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <utility>

namespace recording {
namespace {

struct Primitive {
  std::string_view name;
  std::size_t bytes;
};
constexpr std::array<Primitive, 13> primitives{{{"bool", 1},
                                                {"int8", 1},
                                                {"uint8", 1},
                                                {"int16", 2},
                                                {"uint16", 2},
                                                {"int32", 4},
                                                {"uint32", 4},
                                                {"int64", 8},
                                                {"uint64", 8},
                                                {"float32", 4},
                                                {"float64", 8},
                                                {"string", 0},
                                                {"", 0}}};

/// "erp/msg/SensorFrame" → "erp/SensorFrame", the form in fields and `MSG:` lines.
std::string short_name(const std::string& name) {
  const auto middle = name.find("/msg/");
  return middle == std::string::npos ? name : name.substr(0, middle) + name.substr(middle + 4);
}

void put_type(std::string& out, const TypeDescription& type, const Field& field) {
  out += field.kind == Kind::structure ? short_name(type.structures[field.structure].name)
                                       : std::string(name_of(field.kind));
  if (field.string_bound) out += "<=" + std::to_string(field.string_bound);
  if (field.count == Count::array) out += "[" + std::to_string(field.size) + "]";
  if (field.count == Count::sequence)
    out += field.size ? "[<=" + std::to_string(field.size) + "]" : "[]";
}

void put_structure(std::string& out, const TypeDescription& type, const Structure& structure) {
  std::set<std::string> used_names;
  for (const Field& field : structure.fields) {
    const std::string base_name = ros_field_name(field.name);
    std::string name = base_name;
    for (int n = 2; !used_names.insert(name).second; ++n) name = base_name + std::to_string(n);
    put_type(out, type, field);
    out += " " + name;
    if (name != field.name || !field.unit.empty()) out += "  #";
    if (name != field.name) out += " " + field.name;
    if (!field.unit.empty()) out += " [" + field.unit + "]";
    out += "\n";
  }
}

constexpr std::size_t max_nesting = 32;                              // limit of Cyclone DDS
constexpr std::uint64_t max_message_bytes = std::uint64_t{1} << 31;  // prevents an overflow

void check_field(const TypeDescription& type, const Structure& structure, const Field& field) {
  const std::string place = structure.name + "." + field.name;
  if (structure.find(field.name) != &field)
    throw std::invalid_argument(place + " is defined twice");
  if (field.count == Count::array && field.size == 0)
    throw std::invalid_argument(place + " is an array without elements");
  if (field.kind == Kind::structure && field.structure >= type.structures.size())
    throw std::invalid_argument(place + " has an unknown type");
}

/// Sets `least_bytes` of structure `i` and of all structures in it. `ancestors`: the structures
/// that contain it.
void set_least_bytes(TypeDescription& type, std::size_t i, std::vector<std::size_t>& ancestors) {
  Structure& structure = type.structures[i];
  if (std::ranges::find(ancestors, i) != ancestors.end())
    throw std::invalid_argument(structure.name + " contains itself");
  if (structure.least_bytes) return;
  if (structure.fields.empty()) throw std::invalid_argument(structure.name + " has no fields");
  if (ancestors.size() == max_nesting)
    throw std::invalid_argument(structure.name + " is nested too deeply");
  ancestors.push_back(i);
  std::uint64_t total_bytes = 0;
  for (const Field& field : structure.fields) {
    check_field(type, structure, field);
    if (field.kind == Kind::structure) set_least_bytes(type, field.structure, ancestors);
    const std::uint64_t element_bytes = least_bytes(type, field);
    total_bytes += field.count == Count::sequence
                       ? 4
                       : element_bytes * (field.count == Count::array ? field.size : 1);
    total_bytes = std::min(total_bytes, max_message_bytes);
  }
  ancestors.pop_back();
  structure.least_bytes = static_cast<std::size_t>(total_bytes);
}

}  // namespace

std::string_view name_of(Kind kind) { return primitives[static_cast<std::size_t>(kind)].name; }
std::size_t size_of(Kind kind) { return primitives[static_cast<std::size_t>(kind)].bytes; }

const Field* Structure::find(std::string_view field) const {
  const auto found = std::ranges::find(fields, field, &Field::name);
  return found == fields.end() ? nullptr : &*found;
}

std::string ros_name(std::string_view idl_name) {
  std::vector<std::string> parts{""};
  for (std::size_t i = 0; i < idl_name.size(); ++i) {
    if (idl_name.substr(i, 2) == "::") parts.emplace_back(), ++i;
    else parts.back() += idl_name[i];
  }
  std::string type = parts.back();
  parts.pop_back();
  // ROS 2 on DDS: package::msg::dds_::Type_
  if (parts.size() >= 2 && parts.back() == "dds_" && type.ends_with('_')) {
    type.pop_back();
    parts.pop_back();
  }
  if (parts.size() >= 2 && parts.back() == "msg") parts.pop_back();
  std::string package;
  for (const auto& part : parts) package += (package.empty() ? "" : "_") + part;
  return (package.empty() ? "idl" : package) + "/msg/" + type;
}

std::string ros_field_name(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const bool capital = c >= 'A' && c <= 'Z';
    if (c == '_' && (out.empty() || out.back() == '_')) continue;
    out += capital ? static_cast<char>(c - 'A' + 'a') : c;
  }
  if (out.ends_with('_')) out.pop_back();
  if (out.empty() || (out[0] >= '0' && out[0] <= '9')) out.insert(0, "f");
  return out;
}

std::string ros2msg_text(const TypeDescription& type) {
  std::string out;
  for (const Structure& structure : type.structures) {
    if (&structure != &type.root())
      out += std::string(80, '=') + "\nMSG: " + short_name(structure.name) + "\n";
    put_structure(out, type, structure);
  }
  return out;
}

void check(TypeDescription& type) {
  if (type.structures.empty()) throw std::invalid_argument("a type without structure");
  for (Structure& structure : type.structures) structure.least_bytes = 0;
  std::vector<std::size_t> ancestors;
  set_least_bytes(type, 0, ancestors);
}

std::size_t least_bytes(const TypeDescription& type, const Field& field) {
  if (field.kind == Kind::string) return 4;  // its length
  if (field.kind == Kind::structure) return type.structures[field.structure].least_bytes;
  return size_of(field.kind);
}

}  // namespace recording
