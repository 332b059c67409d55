#pragma once
#include <string>

/// Pictures drawn by gnuplot.
namespace launch {

/// A picture as gnuplot commands, without `set terminal`.
struct PlotScript {
  std::string commands;
  int panels = 0;
};

constexpr int picture_width = 1400;  ///< pixels
constexpr int picture_height(int panels) { return 110 + 230 * panels; }

/// Runs gnuplot and writes `file` atomically. Throws RecordingError when the file name does not end
/// in .svg or .png or when gnuplot is not installed, WriteError when gnuplot fails,
/// std::invalid_argument when the file cannot be created.
void draw(const PlotScript& script, const std::string& file);

}  // namespace launch
