#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/robot/source.hpp"
#include "interfaces/xml/fields.hpp"

/// The CAN buses of a robot and their ECUs.
namespace erp {

struct BusPlan {
  static constexpr auto element = "can_bus";
  static constexpr auto description =
      "CAN bus and its ECUs. Their order is that of the interfaces in a graph. A robot without "
      "<can_bus> has one bus, at 1 Mbit/s, with all its ECUs.";
  xml::Place place;
  std::string name;
  std::vector<int> ecus;
  double bitrate_per_s = 1e6;
  std::optional<double> data_bitrate_per_s;  ///< absent: classic CAN frames
  std::string source;
  void visit(auto& v) {
    v.required("name", name,
               "Name, unique among buses, at most 16 characters; part of the names of its "
               "published statistics.");
    v.required("ecus", ecus,
               {xml::Range{0, 126},
                "CAN addresses of its ECUs, separated by spaces. Every ECU in use is on exactly "
                "one bus."});
    v("bitrate_per_s", bitrate_per_s,
      {xml::Range{10e3, 1e6},
       "Bit rate, of CAN FD frames that of the arbitration phase. An interface with another bit "
       "rate is refused."});
    v("data_bitrate_per_s", data_bitrate_per_s,
      {xml::Range{10e3, 8e6},
       "Bit rate of the data phase of CAN FD frames; at least bitrate_per_s. Default: classic CAN "
       "frames."});
    v("source", source, source_description);
  }
};

}  // namespace erp
