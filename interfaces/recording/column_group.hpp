#pragma once
#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/recording/table.hpp"

namespace recording {

/// Columns of several owners (actuators, joints or ECU channels), addressed by owner and signal.
/// Rows that were not set are NaN.
class ColumnGroup {
 public:
  void set(const std::string& owner, const char* signal, std::size_t row, double value) {
    auto& columns = by_owner_[owner];
    if (columns.empty()) order_.push_back(owner);
    auto column = std::ranges::find(columns, signal, &Column::name);
    if (column == columns.end()) column = columns.insert(columns.end(), Column{signal, {}});
    column->values.resize(std::max(column->values.size(), row + 1), not_taken);
    column->values[row] = value;
  }
  bool has(const std::string& owner) const { return by_owner_.contains(owner); }
  /// Appends all columns to the table as `<owner>.<signal>`, each with `rows` values.
  void move_into(Table& table, std::size_t rows) {
    for (const std::string& owner : order_)
      for (Column& column : by_owner_[owner]) {
        column.values.resize(rows, not_taken);
        table.columns.push_back({owner + "." + column.name, std::move(column.values)});
      }
  }

 private:
  std::map<std::string, std::vector<Column>> by_owner_;
  std::vector<std::string> order_;
};

}  // namespace recording
