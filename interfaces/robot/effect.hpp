#pragma once
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"

namespace erp {

/// `<effect type="gearbox_backlash" on="flexor" width_rad="0.01"/>`. sim/model/effects defines the
/// types and checks targets and parameters.
struct Effect {
  static constexpr auto element = "effect";
  static constexpr auto description =
      "Deviation from the nominal robot that the simulator and the diagnosis add; controllers and "
      "plant ignore it. Further attributes are the parameters of its type.";
  xml::Place place;
  std::string type;
  std::string on;
  std::vector<xml::Attribute> parameters;
  void visit(auto& v) {
    v.required("type", type,
               "Type of the effect, such as gearbox_backlash; `erp model effects` lists all types "
               "with their parameters.");
    v.required("on", on,
               "Name of the affected actuator, drive, joint, body or robot, as the type requires; "
               "NAME.load is the load of a drive with a sensor.");
    v.rest(parameters);
  }
};

}  // namespace erp
