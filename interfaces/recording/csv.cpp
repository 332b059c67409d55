#include "interfaces/recording/csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "interfaces/recording/error.hpp"
#include "interfaces/values.hpp"
#include "interfaces/xml/words.hpp"

namespace recording {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // UTF-8, written by Excel

struct Cell {
  std::string text;
  std::size_t column = 1;  ///< position of its first character in the line, from 1
};

class CsvParser {
 public:
  CsvParser(const std::string& path, std::string_view text) : path_(path), rest_(text) {
    if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
  }

  Table run() {
    take_header();
    while (!rest_.empty()) {
      const auto cells = next_row();
      if (cells.size() == 1 && cells[0].text.empty()) continue;  // an empty line
      take_row(cells);
    }
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(std::size_t column, const std::string& what,
                         const std::string& remedy) const {
    throw RecordingError(path_ + ":" + std::to_string(line_) + ":" + std::to_string(column) + ": " +
                         what + "; " + remedy);
  }

  std::vector<Cell> next_row() {
    ++line_;
    std::vector<Cell> cells{{"", 1}};
    const std::string_view start = rest_;
    const auto column = [&] { return start.size() - rest_.size() + 1; };
    while (!rest_.empty()) {
      const char c = rest_.front();
      if (c == '"' && cells.back().text.empty()) {
        take_quoted(cells.back(), column());
        continue;
      }
      rest_.remove_prefix(1);
      if (c == '\n') break;
      if (c == ',') cells.push_back({"", column()});
      else cells.back().text += c;
    }
    for (Cell& cell : cells) trim(cell.text);
    return cells;
  }

  void take_quoted(Cell& cell, std::size_t column) {
    rest_.remove_prefix(1);
    for (;;) {
      if (rest_.empty()) fail(column, "a quoted cell is not closed", "close it with \"");
      const char c = rest_.front();
      rest_.remove_prefix(1);
      if (c == '"' && !rest_.starts_with('"')) return;
      if (c == '"') rest_.remove_prefix(1);
      cell.text += c;
    }
  }

  static void trim(std::string& text) {
    constexpr auto* blanks = " \t\r";
    text.erase(text.find_last_not_of(blanks) + 1);
    text.erase(0, text.find_first_not_of(blanks));
  }

  void take_header() {
    const auto cells = next_row();
    const bool empty = cells.size() == 1 && cells[0].text.empty();
    if (cells[0].text.find(';') != std::string::npos)
      fail(1, "the columns are separated by semicolons",
           "separate them by commas, and write numbers with a decimal point");
    if (!empty) std::ranges::for_each(cells, [&](const Cell& cell) { take_name(cell); });
    if (!table_.find("time_s")) fail(1, "there is no column time_s", "add it as the first column");
    std::ranges::stable_partition(order_, [&](std::size_t i) { return cells[i].text == "time_s"; });
    std::ranges::stable_partition(table_.columns,
                                  [](const Column& c) { return c.name == "time_s"; });
    target_.resize(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) target_[order_[i]] = i;
  }

  void take_name(const Cell& cell) {
    const std::string& name = cell.text;
    const std::string_view signal = signal_of(name);
    const auto& signals = known_signals();
    if (table_.find(name)) fail(cell.column, "column \"" + name + "\" occurs twice", "remove one");
    constexpr std::array other_times{"t", "time", "time_ms", "time_us", "time_ns"};
    if (std::ranges::find(other_times, name) != other_times.end())
      fail(cell.column, "unknown column " + xml::quote(name), "name it time_s, in seconds");
    if (name != "time_s" &&
        (signal.size() == name.size() || std::ranges::find(signals, signal) == signals.end()))
      fail(cell.column, "unknown column " + xml::quote(name),
           signal.size() == name.size() ? "name it <actuator or joint>.<signal>"
                                        : xml::did_you_mean(name, signals_of_owner(name, signal)));
    order_.push_back(order_.size());
    table_.columns.push_back({name, {}});
  }

  /// All valid column names of the owner in `name`.
  static std::vector<std::string> signals_of_owner(const std::string& name,
                                                   std::string_view signal) {
    const std::string owner = name.substr(0, name.size() - signal.size());
    std::vector<std::string> all;
    for (const auto& valid : known_signals()) all.push_back(owner + std::string(valid));
    return all;
  }

  void take_row(const std::vector<Cell>& cells) {
    if (cells.size() != target_.size())
      fail(cells[std::min(cells.size() - 1, target_.size())].column,
           "the row has " + std::to_string(cells.size()) + " cells, the header " +
               std::to_string(target_.size()),
           "write numbers with a decimal point and leave cells empty that have no value");
    for (std::size_t i = 0; i < cells.size(); ++i) {
      Column& column = table_.columns[target_[i]];
      column.values.push_back(value_of(cells[i], column.name));
    }
    const auto& time_s = table_.columns.front().values;
    const Cell& cell = cells[order_.front()];
    if (std::isnan(time_s.back())) fail(cell.column, "time_s is empty", "every row needs its time");
    if (time_s.size() > 1 && time_s.back() < time_s[time_s.size() - 2])
      fail(cell.column, "time_s steps back to " + cell.text,
           time_s.back() <= time_s.front() ? "two recordings in one: give each a file of its own"
                                           : "sort the rows by the time of measurement; times of "
                                             "arrival may overtake each other");
  }

  double value_of(const Cell& cell, const std::string& column) const {
    if (cell.text.empty()) return not_taken;
    return holds_mode(column) ? mode(cell) : number(cell);
  }

  double mode(const Cell& cell) const {
    for (const auto mode : {erp::Mode::off, erp::Mode::voltage, erp::Mode::length,
                            erp::Mode::current, erp::Mode::force})
      if (cell.text == erp::name_of(mode)) return static_cast<double>(mode);
    fail(cell.column, "unknown mode \"" + cell.text + "\"",
         "use off, voltage, length, current, force or leave it empty");
  }

  double number(const Cell& cell) const {
    std::string_view text = cell.text;
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range)
      fail(cell.column, "\"" + cell.text + "\" is beyond what a double holds", "scale it");
    if (error != std::errc{} || end != text.data() + text.size())
      fail(cell.column, "\"" + cell.text + "\" is not a number",
           "write it with a decimal point, or leave the cell empty");
    return value;
  }

  const std::string& path_;
  std::string_view rest_;
  std::size_t line_ = 0;
  Table table_;
  std::vector<std::size_t> order_;   ///< table column → cell of a row
  std::vector<std::size_t> target_;  ///< cell of a row → table column
};

}  // namespace

Table parse_csv(const std::string& path, std::string_view text) {
  return CsvParser(path, text).run();
}

}  // namespace recording
