#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "interfaces/xml/renamed.hpp"

/// Former names of verbs and options. They work with a warning; --help does not list them.
namespace launch {

/// The verb with all its parents: "erp gap confounders".
inline std::string full_name(const CLI::App& verb) {
  const CLI::App* parent = verb.get_parent();
  return (parent ? full_name(*parent) + " " : "") + verb.get_name();
}

/// Accepts `former` as another name of the option `name`, which `verb` must already have.
inline void add_former_option(CLI::App& verb, const std::string& former, const std::string& name) {
  CLI::Option* current = verb.get_option(name);
  verb.add_option_function<std::string>(former,
                                        [=, &verb](const std::string& text) {
                                          xml::warn_renamed({full_name(verb)}, former, name);
                                          current->add_result(text);
                                          current->run_callback();
                                        })
      ->group("");
}

/// Hides `verb` and makes it warn that it is the former name of the verb `name`. Call it before
/// setting the callback of `verb`.
inline void mark_former_verb(CLI::App& verb, const std::string& name) {
  verb.group("");
  verb.parse_complete_callback(
      [=, &verb] { xml::warn_renamed({full_name(*verb.get_parent())}, verb.get_name(), name); });
}

}  // namespace launch
