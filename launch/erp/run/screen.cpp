#include "launch/erp/run/screen.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "launch/erp/text/columns.hpp"

namespace launch {
namespace {

struct Size {
  std::size_t rows = 24, columns = 80;
};

Size size_of(std::FILE* out) {
  winsize size{};
  if (ioctl(fileno(out), TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return {};
  return {size.ws_row, size.ws_col};
}

}  // namespace

Screen::Screen(std::FILE* out) : out_(out), is_terminal_(isatty(fileno(out)) != 0) {}

void Screen::print(double time_s, const std::string& text) {
  clear();
  std::fprintf(out_, "%8.2f  %s\n", time_s, text.c_str());
  draw();
  std::fflush(out_);
}

void Screen::show(const Status& status) {
  if (is_terminal_) {
    clear();
    table_ = render(status);
    draw();
    std::fflush(out_);
    return;
  }
  for (const auto& row : status.rows) {
    auto& printed = states_[row.name];
    if (printed == row.state) continue;
    printed = row.state;
    print(status.elapsed_s, row.name + ": " + row.state);
  }
}

void Screen::clear() {
  if (drawn_lines_) std::fprintf(out_, "\033[%zuA\r\033[J", drawn_lines_);
  drawn_lines_ = 0;
}

void Screen::draw() {
  if (!is_terminal_) return;
  const Size size = size_of(out_);
  const std::size_t max_lines = std::max<std::size_t>(size.rows, 4) - 2;
  drawn_lines_ = std::min(table_.size(), max_lines);
  for (std::size_t i = 0; i < drawn_lines_; ++i) {
    const bool is_truncated = i + 1 == drawn_lines_ && drawn_lines_ < table_.size();
    const std::string line =
        is_truncated ? "… and " + std::to_string(table_.size() - i) + " more" : table_[i];
    std::fprintf(out_, "%s\n", clipped(line, size.columns).c_str());
  }
}

}  // namespace launch
