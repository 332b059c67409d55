#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "launch/erp/text/gnuplot.hpp"

namespace launch {

/// One panel a signal, stacked over a common time: solid what was measured, dashed what was asked
/// for (the reference in the panel's mode, else the target). `signals` as in LogPlotOptions;
/// `place` names the recording in errors. Throws RecordingError when nothing matches.
PlotScript plot_script(const recording::Table& table, const std::vector<std::string>& signals,
                       const std::string& title, const std::string& place);

}  // namespace launch
