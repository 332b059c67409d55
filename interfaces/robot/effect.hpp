#pragma once
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"

namespace erp {

/// Something the nominal robot leaves out and the simulator adds: `<effect type="gearbox_backlash"
/// on="flexor" width_rad="0.01"/>`. Which types there are, on what, and their parameters:
/// sim/model/effects, which checks them. Components other than the simulator do not look at effects.
struct Effect {
  static constexpr auto element = "effect";
  xml::Place place;
  std::string type;
  std::string on;  ///< name of an actuator, joint, body or of the robot
  std::vector<xml::Attribute> parameters;
  void visit(auto& v) {
    v.required("type", type);
    v.required("on", on);
    v.rest(parameters);
  }
};

}  // namespace erp
