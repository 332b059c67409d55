#pragma once
#include <string>
#include <string_view>
#include <vector>

/// Words for error messages: the nearest known name, lists, quotes.
namespace xml {

/// The Levenshtein distance: how many letters to insert, delete or replace; case is ignored.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name that `name` was probably meant to be, or "" if none is close.
/// A name without its unit, or with another one, counts as close.
std::string nearest(std::string_view name, const std::vector<std::string>& known);

/// `did you mean "x"?`, or the whole list of known names when none is close.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

/// In quotation marks; of a long or many-lined text the beginning.
std::string quote(std::string_view text);
std::string joined(const std::vector<std::string>& words, std::string_view separator = ", ");
std::string_view trimmed(std::string_view text);
std::vector<std::string_view> split(std::string_view text);  ///< at white space

}  // namespace xml
