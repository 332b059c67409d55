#pragma once
#include <ostream>
#include <string>
#include <string_view>

#include "interfaces/recording/table.hpp"

namespace recording {

/// Writes a table as CSV. Numbers have the fewest digits that read back bit-equal, modes are names,
/// a sample that was not taken is an empty cell. Equal tables give equal bytes.
void write_csv(const Table& table, std::ostream& out);

/// Reads a table from CSV text. Columns may be missing and cells empty; `time_s` is required and
/// must not decrease. Throws RecordingError "file:line:column: what, value; remedy".
Table parse_csv(const std::string& path, std::string_view text);

/// The text of a cell, quoted if necessary.
std::string csv_cell(std::string_view text);
/// The number with the fewest digits that read back bit-equal; empty for NaN.
std::string csv_number(double value);

}  // namespace recording
