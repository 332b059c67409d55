#include "launch/erp/verbs/man_page.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ostream>
#include <vector>

namespace launch {
namespace {

/// The UTF-8 character at text[i] in roff; moves `i` past it. Special characters are escaped, characters outside ASCII are given
/// by number.
std::string roff_character(const std::string& text, std::size_t& i) {
  const auto byte = static_cast<unsigned char>(text[i++]);
  if (byte == '\\') return "\\e";
  if (byte == '-') return "\\-";
  if (byte < 0x80) return std::string(1, static_cast<char>(byte));
  std::uint32_t code = byte & (byte >= 0xF0 ? 0x07 : byte >= 0xE0 ? 0x0F : 0x1F);
  while (i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80)
    code = code << 6 | (static_cast<unsigned char>(text[i++]) & 0x3F);
  char number[16];
  std::snprintf(number, sizeof number, "\\[u%04X]", static_cast<unsigned>(code));
  return number;
}

/// Text of a paragraph in roff. Line breaks are kept, empty lines and indentation are not. `\&`
/// prevents that a line is read as a roff request.
std::string roff(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const bool begins_line = out.empty() || out.back() == '\n';
    if (begins_line && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    if (begins_line && (text[i] == '\n' || text[i] == ' ')) ++i;  // no empty or indented lines
    else out += roff_character(text, i);
  }
  return out;
}

std::string type_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "";
  const std::string type = option.get_type_name();
  return type + (option.get_items_expected_max() > 1 ? " ..." : "");
}

std::string names_of(const CLI::Option& option) {
  if (option.nonpositional()) {
    std::string names = option.get_name(false, true);
    for (std::size_t comma = names.find(','); comma != names.npos;
         comma = names.find(',', comma + 2))
      names.replace(comma, 1, ", ");
    return names;
  }
  return option.get_name(true);
}

bool is_hidden(const CLI::Option& option) { return option.get_group().empty(); }

void print_options(const CLI::App& verb, std::ostream& out) {
  for (const auto* option : verb.get_options()) {
    if (is_hidden(*option) || option == verb.get_help_ptr()) continue;
    out << ".TP\n\\fB" << roff(names_of(*option)) << "\\fR";
    if (const auto type = type_of(*option); !type.empty() && option->nonpositional())
      out << " \\fI" << roff(type) << "\\fR";
    out << '\n' << roff(option->get_description());
    if (option->get_required()) out << " (required)";
    if (!option->get_default_str().empty())
      out << " (default: " << roff(option->get_default_str()) << ")";
    out << '\n';
  }
}

std::string usage(const CLI::App& verb, const std::string& name) {
  std::string text = "\\fB" + roff(name) + "\\fR";
  for (const auto* option : verb.get_options()) {
    if (is_hidden(*option) || option->nonpositional()) continue;
    const std::string argument = "\\fI" + roff(option->get_name(true)) + "\\fR";
    text += option->get_required() ? " " + argument : " [" + argument + "]";
  }
  return text + " [options]";
}

/// Former names of verbs are in no group, and not listed.
bool is_listed(const CLI::App* verb) { return !verb->get_group().empty(); }

/// `common_footer`: footer of the program, which every verb inherits; printed once, at the end.
void print_verb(const CLI::App& verb, const std::string& name, const std::string& common_footer,
                std::ostream& out) {
  const auto verbs = verb.get_subcommands(is_listed);
  if (verbs.empty()) {
    out << ".SS " << usage(verb, name) << '\n' << roff(verb.get_description()) << ".\n";
    print_options(verb, out);
    if (const auto footer = verb.get_footer(); !footer.empty() && footer != common_footer)
      out << ".PP\n" << roff(footer) << '\n';
  }
  for (const auto* inner : verbs)
    print_verb(*inner, name + " " + inner->get_name(), common_footer, out);
}

std::string to_upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

}  // namespace

void print_man_page(const CLI::App& app, std::ostream& out) {
  const std::string name = app.get_name();
  out << ".\\\" Generated from the command line of " << name << "; do not edit.\n.TH "
      << to_upper(name) << " 1 \"\" \"" << roff(app.version()) << "\" \"User Commands\"\n.SH NAME\n"
      << name << " \\- " << roff(app.get_description()) << "\n.SH SYNOPSIS\n\\fB" << name
      << "\\fR \\fIVERB\\fR [options]\n.br\n\\fB" << name
      << "\\fR \\fIVERB\\fR \\fB\\-\\-help\\fR\n.br\n\\fB" << name
      << "\\fR \\fB\\-\\-version\\fR\n";
  std::string group;
  for (const auto* verb : app.get_subcommands(is_listed)) {
    if (verb->get_group() != group)
      out << ".SH " << roff(to_upper(group = verb->get_group())) << '\n';
    print_verb(*verb, name + " " + verb->get_name(), app.get_footer(), out);
  }
  out << ".SH EXIT STATUS AND ENVIRONMENT\n" << roff(app.get_footer()) << '\n';
}

}  // namespace launch
