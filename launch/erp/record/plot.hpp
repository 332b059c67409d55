#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "launch/erp/text/gnuplot.hpp"

namespace launch {

/// One panel per signal over a common time axis. Solid lines are measured values. Dashed lines are
/// desired values: the reference in the mode of the panel, otherwise the target. `signals`: see
/// LogPlotOptions. `file`: name of the recording in errors. Throws RecordingError when no signal
/// matches.
PlotScript plot_script(const recording::Table& table, const std::vector<std::string>& signals,
                       const std::string& title, const std::string& file);

}  // namespace launch
