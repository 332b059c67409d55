#include <array>
#include <charconv>
#include <cmath>

#include "interfaces/recording/csv.hpp"
#include "interfaces/values.hpp"

namespace recording {

std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) (out += c == '"' ? "\"" : "") += c;
  return out += '"';
}

std::string csv_number(double value) {
  if (std::isnan(value)) return {};
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

void write_csv(const Table& table, std::ostream& out) {
  std::string row;
  const auto put = [&](const std::string& cell, std::size_t column) {
    if (column) row += ',';
    row += cell;
  };
  const auto end_row = [&] {
    row += '\n';
    out.write(row.data(), static_cast<std::streamsize>(row.size()));
    row.clear();
  };
  for (std::size_t c = 0; c < table.columns.size(); ++c) put(csv_cell(table.columns[c].name), c);
  end_row();
  for (std::size_t r = 0; r < table.rows(); ++r) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const double value = table.columns[c].values[r];
      const bool is_mode = holds_mode(table.columns[c].name) && !std::isnan(value);
      put(is_mode ? erp::name_of(static_cast<erp::Mode>(value)) : csv_number(value), c);
    }
    end_row();
  }
}

}  // namespace recording
