#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"

namespace launch {

/// A picture as gnuplot commands, the terminal left out.
struct PlotScript {
  std::string commands;
  int panels = 0;
};

constexpr int picture_width = 1400;  ///< pixels
constexpr int picture_height(int panels) { return 110 + 230 * panels; }

/// One panel a signal, stacked over a common time: solid what was measured, dashed what was asked
/// for (the reference in the panel's mode, else the target). `signals` as in LogPlotOptions;
/// `place` names the recording in errors. Throws RecordingError when nothing matches.
PlotScript plot_script(const recording::Table& table, const std::vector<std::string>& signals,
                       const std::string& title, const std::string& place);

/// Runs gnuplot; the file appears whole or not at all. Throws RecordingError when its name does not
/// end in .svg or .png or gnuplot is missing or fails, WriteError when it cannot be written.
void draw(const PlotScript& script, const std::string& file);

}  // namespace launch
