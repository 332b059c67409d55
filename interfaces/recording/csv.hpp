#pragma once
#include <ostream>
#include <string>
#include <string_view>

#include "interfaces/recording/table.hpp"

namespace recording {

/// Writes a table as CSV; numbers in the fewest digits that read back bit-equal, modes as words,
/// an empty cell where a sample was not taken. The same table always gives the same bytes.
void write_csv(const Table& table, std::ostream& out);

/// Reads a table from CSV text. Columns may be missing, cells empty; `time_s` is needed and never
/// steps back. Throws RecordingError "file:line:column: what, value; remedy".
Table parse_csv(const std::string& path, std::string_view text);

/// A cell: quoted when it must be.
std::string csv_cell(std::string_view text);
/// The fewest digits that read back bit-equal; empty for NaN.
std::string csv_number(double value);

}  // namespace recording
