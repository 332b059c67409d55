#pragma once
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "launch/erp/run/status_table.hpp"

/// Output of a run. On a terminal: a table that is redrawn below the printed lines. Otherwise: one
/// line per change.
namespace launch {

class Screen {
 public:
  /// The last table stays on the terminal when the screen is destroyed.
  explicit Screen(std::FILE* out);
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// `time_s`: time since the start of the run.
  void print(double time_s, const std::string& text);
  void show(const Status& status);
  bool is_terminal() const { return is_terminal_; }

 private:
  void clear();
  void draw();

  std::FILE* out_;
  bool is_terminal_;
  std::vector<std::string> table_;
  std::size_t drawn_lines_ = 0;  ///< lines of the table that are on the terminal
  /// Without a terminal: the state that was printed last, by component.
  std::map<std::string, std::string> states_;
};

}  // namespace launch
