#pragma once
#include <string>
#include <vector>

/// Small drawings for a page: inline SVG, no script, nothing fetched.
namespace launch::gap::svg {

std::string escaped(const std::string& text);

struct Line {
  std::string label, colour;
  std::vector<double> x, y;  ///< NaN: a gap
};

struct Axes {
  std::string title, x_label, y_label;
  int width = 720, height = 240;
  double band = 0;  ///< drawn around zero: what noise does; 0: none
};

std::string plot(const Axes& axes, const std::vector<Line>& lines);

struct Bar {
  std::string label, note;
  double value = 0, low = 0, high = 0;  ///< whiskers when low < high
  bool strong = false;
};

/// Horizontal bars from 0; values beyond 0 … `most` are cut, and the note tells the figure.
std::string bars(const std::string& title, const std::vector<Bar>& bars, double most);

/// Cells from 0 (white) to 1 (dark).
std::string matrix(const std::string& title, const std::vector<std::string>& rows,
                   const std::vector<std::string>& columns,
                   const std::vector<std::vector<double>>& cells);

/// Boxes in a row with an arrow between, each with a share in 0 … 1 as its shade and a note of it.
std::string chain(const std::string& title, const std::vector<std::string>& boxes,
                  const std::vector<double>& shares, const std::vector<std::string>& notes);

}  // namespace launch::gap::svg
