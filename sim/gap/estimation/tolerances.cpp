#include "sim/gap/estimation/tolerances.hpp"

#include <set>

#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/words.hpp"

namespace sim::estimation {
namespace {

bool applies_to(const erp::Tolerance& given, const Constant& c) {
  return c.name == given.of && (given.on.empty() || c.on == given.on);
}

/// Message and remedy for an invalid <tolerance>; empty if it is valid.
std::pair<std::string, std::string> error_of(const erp::Tolerance& given,
                                             const std::vector<Constant>& all) {
  std::set<std::string> names;
  bool applies = false, is_zero = false;
  for (const Constant& c : all) {
    names.insert(c.name);
    if (applies_to(given, c)) applies = true, is_zero |= c.nominal == 0;
  }
  const std::string of = "of=" + xml::quote(given.of);
  if (!applies)
    return {of + " names no number" + (given.on.empty() ? "" : " of " + given.on) +
                " that is estimated",
            xml::did_you_mean(given.of, {names.begin(), names.end()})};
  if (is_zero && given.relative)
    return {of + " is 0 in robot.xml", "set absolute instead, in its unit"};
  return {};
}

}  // namespace

void apply_tolerances(std::vector<Constant>& all, const erp::Robot& robot) {
  std::vector<xml::Error> errors;
  for (const erp::Tolerance& given : robot.tolerances) {
    if (const auto [what, remedy] = error_of(given, all); !what.empty())
      errors.push_back(xml::error_in(given.element, given.place, what, remedy));
    for (Constant& c : all)
      if (applies_to(given, c))
        c.tolerance = given.absolute ? *given.absolute : *given.relative * c.nominal;
  }
  xml::throw_if_any(std::move(errors));
  std::erase_if(all, [](const Constant& c) { return c.tolerance == 0; });
}

}  // namespace sim::estimation
