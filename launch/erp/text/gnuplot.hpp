#pragma once
#include <string>

/// Pictures by gnuplot.
namespace launch {

/// A picture as gnuplot commands, the terminal left out.
struct PlotScript {
  std::string commands;
  int panels = 0;
};

constexpr int picture_width = 1400;  ///< pixels
constexpr int picture_height(int panels) { return 110 + 230 * panels; }

/// Runs gnuplot; the file appears whole or not at all. Throws RecordingError when its name does not
/// end in .svg or .png or gnuplot is missing or fails, WriteError when it cannot be written.
void draw(const PlotScript& script, const std::string& file);

}  // namespace launch
