#pragma once
#include <string>
#include <string_view>
#include <vector>

/// Text functions for error messages: the nearest known name, lists, quotes.
namespace xml {

/// Levenshtein distance: number of letters to insert, delete or replace; ignores case.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name nearest to `name`, or "" if none is near. A name without its unit, or with
/// another unit, counts as near.
std::string nearest(std::string_view name, const std::vector<std::string>& known);

/// `did you mean "x"?`, or the list of all known names when none is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

/// The text in quotation marks. A long text is truncated. A text of several lines is truncated
/// after its first line.
std::string quote(std::string_view text);
std::string joined(const std::vector<std::string>& words, std::string_view separator = ", ");
std::string_view trimmed(std::string_view text);
std::vector<std::string_view> split(std::string_view text);  ///< at white space

}  // namespace xml
