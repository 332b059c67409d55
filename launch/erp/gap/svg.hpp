#pragma once
#include <string>
#include <vector>

/// Diagrams as inline SVG, without scripts or external files.
namespace launch::gap::svg {

struct Line {
  std::string label, colour;
  std::vector<double> x, y;  ///< NaN: the line is interrupted
};

struct Axes {
  std::string title, x_label, y_label;
  int width = 720, height = 240;
  double band = 0;  ///< half width of the noise band around zero; 0: no band
};

std::string plot(const Axes& axes, const std::vector<Line>& lines);

struct Bar {
  std::string label, note;
  double value = 0, low = 0, high = 0;  ///< whiskers when low < high
  bool strong = false;                  ///< dark colour
};

/// Horizontal bars from 0. Values outside 0 … `max_value` are clipped. `note` is printed beside the
/// bar.
std::string bars(const std::string& title, const std::vector<Bar>& bars, double max_value);

/// A table of cells. The shade of a cell shows its value, from 0 (white) to 1 (dark).
std::string matrix(const std::string& title, const std::vector<std::string>& rows,
                   const std::vector<std::string>& columns,
                   const std::vector<std::vector<double>>& cells);

/// Boxes in a row, connected by arrows. `shares` (0 … 1) sets their shade; `notes` is printed in
/// them.
std::string chain(const std::string& title, const std::vector<std::string>& boxes,
                  const std::vector<double>& shares, const std::vector<std::string>& notes);

}  // namespace launch::gap::svg
