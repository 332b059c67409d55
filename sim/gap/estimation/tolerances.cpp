#include "sim/gap/estimation/tolerances.hpp"

#include <set>

#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/words.hpp"

namespace sim::estimation {
namespace {

bool is_about(const erp::Tolerance& given, const Constant& c) {
  return c.name == given.of && (given.on.empty() || c.on == given.on);
}

/// What of a <tolerance> cannot be: the message and the remedy; empty if nothing.
std::pair<std::string, std::string> refused(const erp::Tolerance& given,
                                            const std::vector<Constant>& all) {
  std::set<std::string> names;
  bool named = false, zero = false;
  for (const Constant& c : all) {
    names.insert(c.name);
    if (is_about(given, c)) named = true, zero |= c.nominal == 0;
  }
  const std::string of = "of=" + xml::quote(given.of);
  if (!named)
    return {of + " names no number" + (given.on.empty() ? "" : " of " + given.on) +
                " that is estimated",
            xml::did_you_mean(given.of, {names.begin(), names.end()})};
  if (zero && given.relative) return {of + " is 0 in robot.xml", "give absolute, in its unit"};
  return {};
}

}  // namespace

void apply_tolerances(std::vector<Constant>& all, const erp::Robot& robot) {
  std::vector<xml::Error> errors;
  for (const erp::Tolerance& given : robot.tolerances) {
    if (const auto [what, remedy] = refused(given, all); !what.empty())
      errors.push_back(xml::error_in(given.element, given.place, what, remedy));
    for (Constant& c : all)
      if (is_about(given, c))
        c.tolerance = given.absolute ? *given.absolute : *given.relative * c.nominal;
  }
  xml::throw_if_any(std::move(errors));
  std::erase_if(all, [](const Constant& c) { return c.tolerance == 0; });
}

}  // namespace sim::estimation
