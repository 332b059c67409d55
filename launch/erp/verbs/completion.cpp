#include "launch/erp/verbs/completion.hpp"

#include <ostream>
#include <string>

namespace launch {
namespace {

std::string verbs_of(const CLI::App& app) {
  std::string words;
  for (const auto* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    words += (words.empty() ? "" : " ") + verb->get_name();
  return words;
}

std::string options_of(const CLI::App& app) {
  std::string words;
  for (const auto* option : app.get_options()) {
    if (option->get_group().empty() || !option->nonpositional()) continue;
    for (const auto& name : option->get_lnames()) words += (words.empty() ? "--" : " --") + name;
    for (const auto& name : option->get_snames()) words += (words.empty() ? "-" : " -") + name;
  }
  return words;
}

/// Prints the case of the script for `app`, with the preceding words `path`, and the cases of its
/// verbs.
void print_cases(const CLI::App& app, const std::string& path, std::ostream& out) {
  out << "    '" << path << "') verbs='" << verbs_of(app) << "' options='" << options_of(app)
      << "' ;;\n";
  for (const auto* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    print_cases(*verb, path + " " + verb->get_name(), out);
}

}  // namespace

void print_bash_completion(const CLI::App& app, std::ostream& out) {
  const std::string name = app.get_name(), function = "_" + name;
  out << "# Generated from the command line of " << name << "; do not edit.\n"
      << function << "_words() {\n  case $1 in\n";
  print_cases(app, "", out);
  out << "    *) return 1 ;;\n  esac\n}\n\n"
      << function << "() {\n"
      << R"(  local current=${COMP_WORDS[COMP_CWORD]} path= verbs= options= i
  for ((i = 1; i < COMP_CWORD; i++)); do
    )" << function
      << R"(_words "$path" && [[ " $verbs " == *" ${COMP_WORDS[i]} "* ]] && path+=" ${COMP_WORDS[i]}"
  done
  )" << function
      << R"(_words "$path"
  [[ $current == -* ]] && verbs=$options
  mapfile -t COMPREPLY < <(compgen -W "$verbs" -- "$current")
}
complete -o default -F )"
      << function << " " << name << '\n';
}

}  // namespace launch
