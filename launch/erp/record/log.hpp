#pragma once
#include <iosfwd>
#include <string>
#include <vector>

/// `erp log info|export|recover|plot`: what a person does with a recording.
/// All return 0 done, 1 the result could not be written, 2 the input is bad; errors go to stderr
/// with place, value and remedy.
namespace launch {

struct LogExportOptions {
  std::string topic;  ///< empty: one row per sensor_frame; else this topic's messages
  std::string robot;  ///< empty: the only one
};

struct LogPlotOptions {
  /// Which curves: actuators or joints ("flexor"), signals ("tension_N"), or one of both
  /// ("flexor.tension_N"). Empty: tension, line length and joint angle of everything.
  std::vector<std::string> signals;
  std::string robot;  ///< empty: the only one
  std::string title;  ///< empty: the file's name
};

/// Duration, topics with counts, rates and missing messages, attachments, whole or cut off.
int log_info(const std::string& path, std::ostream& out);

/// The recording (MCAP or CSV) as CSV.
int log_export(const std::string& path, std::ostream& out, const LogExportOptions& options = {});

/// Copies what can be read of `in` into the new file `out`, and says what could not. Returns 1 when
/// there was nothing.
int log_recover(const std::string& in, const std::string& out, std::ostream& said);

/// Draws the recording (MCAP or CSV) into `out`, an .svg or .png file. Needs gnuplot.
int log_plot(const std::string& path, const std::string& out, const LogPlotOptions& options = {});

}  // namespace launch
