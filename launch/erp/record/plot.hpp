#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "launch/erp/text/gnuplot.hpp"

namespace launch {

/// One panel per signal over a common time axis. Solid: measured value. Dashed: desired value, that
/// is the reference in the mode of the panel, else the target. `signals` as in LogPlotOptions;
/// `place` names the recording in errors. Throws RecordingError when no signal matches.
PlotScript plot_script(const recording::Table& table, const std::vector<std::string>& signals,
                       const std::string& title, const std::string& place);

}  // namespace launch
