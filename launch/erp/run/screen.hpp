#pragma once
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "launch/erp/run/status_table.hpp"

/// Where a run is shown: on a terminal a table redrawn in place below the lines said so far,
/// anywhere else one plain line for each change.
namespace launch {

class Screen {
 public:
  /// The last table stays when the screen goes: what is printed next stands below it.
  explicit Screen(std::FILE* out);
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// `time_s`: since the run began.
  void say(double time_s, const std::string& text);
  void show(const Status& status);
  bool is_terminal() const { return terminal_; }

 private:
  void clear();
  void draw();

  std::FILE* out_;
  bool terminal_;
  std::vector<std::string> table_;
  std::size_t drawn_ = 0;                      ///< lines of the table on the terminal now
  std::map<std::string, std::string> states_;  ///< as said last, where there is no terminal
};

}  // namespace launch
