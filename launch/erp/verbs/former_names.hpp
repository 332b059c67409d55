#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "interfaces/xml/renamed.hpp"

/// Former names of verbs and options: they work with a warning and are not listed by --help.
namespace launch {

/// "erp gap confounders"
inline std::string full_name(const CLI::App& verb) {
  const CLI::App* parent = verb.get_parent();
  return (parent ? full_name(*parent) + " " : "") + verb.get_name();
}

/// The option `name` of `verb`, which must already have it, is also read as `former`.
inline void add_former_option(CLI::App& verb, const std::string& former, const std::string& name) {
  CLI::Option* now = verb.get_option(name);
  verb.add_option_function<std::string>(former,
                                        [=, &verb](const std::string& text) {
                                          xml::warn_renamed({full_name(verb)}, former, name);
                                          now->add_result(text);
                                          now->run_callback();
                                        })
      ->group("");
}

/// Hides `verb` and lets it report that it is the former name of the verb `name`. Call it before the
/// callback of `verb` is set.
inline void mark_former_verb(CLI::App& verb, const std::string& name) {
  verb.group("");
  verb.parse_complete_callback(
      [=, &verb] { xml::warn_renamed({full_name(*verb.get_parent())}, verb.get_name(), name); });
}

}  // namespace launch
