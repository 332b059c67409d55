#include "interfaces/xml/words.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace xml {
namespace {

constexpr std::string_view blanks = " \t\r\n";

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// The name without its unit: `mass` for `mass_kg`.
std::string_view stem(std::string_view name) { return name.substr(0, name.find('_')); }

std::size_t distance(std::string_view name, std::string_view candidate) {
  const bool unit_forgotten = candidate.starts_with(std::string(name) + "_");
  const bool group_forgotten = candidate.ends_with("_" + std::string(name));
  const bool other_unit = name.find('_') != name.npos && stem(name) == stem(candidate);
  const std::size_t edits = edit_distance(name, candidate);
  return unit_forgotten || group_forgotten || other_unit ? std::min<std::size_t>(edits, 2) : edits;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // D(i,j) = min(D(i−1,j) + 1, D(i,j−1) + 1, D(i−1,j−1) + [aᵢ ≠ bⱼ]), only one row is stored
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0u);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i - 1]) != lower(b[j - 1]));
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

std::string nearest(std::string_view name, const std::vector<std::string>& known) {
  std::string nearest_name;
  std::size_t smallest_distance = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t candidate_distance = distance(name, candidate);
    const bool is_nearer = candidate_distance < smallest_distance ||
                           (candidate_distance == smallest_distance && !nearest_name.empty() &&
                            edit_distance(name, candidate) < edit_distance(name, nearest_name));
    if (is_nearer && candidate_distance < candidate.size())
      nearest_name = candidate, smallest_distance = candidate_distance;
  }
  return nearest_name;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  if (const std::string suggestion = nearest(name, known); !suggestion.empty())
    return "did you mean " + quote(suggestion) + "?";
  return known.empty() ? "remove it" : "valid names: " + joined(known);
}

std::string quote(std::string_view text) {
  constexpr std::size_t max_quoted_bytes = 120;  // chosen: fits a message
  const std::size_t end = std::min({text.find('\n'), text.size(), max_quoted_bytes});
  return "\"" + std::string(text.substr(0, end)) + (end < text.size() ? "…\"" : "\"");
}

std::string joined(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t end = std::min(text.find_first_of(blanks), text.size());
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return parts;
}

}  // namespace xml
