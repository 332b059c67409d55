#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"

/// How a robot's ECUs hang on CAN buses.
namespace erp {

/// One CAN bus and the ECUs on it. A robot that names none has one, at 1 Mbit/s, with all its ECUs.
struct BusPlan {
  static constexpr auto element = "can_bus";
  xml::Place place;
  std::string name;
  std::vector<int> ecus;
  double bitrate_per_s = 1e6;
  /// Of the data phase of CAN FD frames; absent: classic frames.
  std::optional<double> data_bitrate_per_s;
  std::string source;
  void visit(auto& v) {
    v.required("name", name);
    v.required("ecus", ecus, xml::Range{0, 126});
    v("bitrate_per_s", bitrate_per_s, xml::Range{10e3, 1e6});
    v("data_bitrate_per_s", data_bitrate_per_s, xml::Range{10e3, 8e6});
    v("source", source);
  }
};

}  // namespace erp
