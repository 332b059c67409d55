#pragma once
#include <iosfwd>
#include <string>
#include <vector>

/// `erp log info|export|recover|plot|effort`. All functions return 0 done, 1 result not written, 2
/// bad input, and print errors on stderr with place, value and remedy.
namespace launch {

struct LogExportOptions {
  std::string topic;  ///< empty: one row per sensor_frame; otherwise the messages of this topic
  std::string robot;  ///< empty: the only robot of the recording
};

struct LogPlotOptions {
  /// Curves to draw: actuators or joints ("flexor"), signals ("tension_N"), or single curves
  /// ("flexor.tension_N"). Empty: tensions, line lengths and joint angles of all.
  std::vector<std::string> signals;
  std::string robot;  ///< empty: the only robot of the recording
  std::string title;  ///< empty: the file name
};

/// Prints duration, topics with counts, rates and missing messages, attachments, and whether the
/// file is complete.
int log_info(const std::string& path, std::ostream& out);

/// Prints the recording (MCAP or CSV) as CSV.
int log_export(const std::string& path, std::ostream& out, const LogExportOptions& options = {});

/// Copies all readable messages of `in` into the new file `out` and prints the unreadable parts to
/// `report`. Returns 1 if there are no readable messages.
int log_recover(const std::string& in, const std::string& out, std::ostream& report);

/// Draws the recording (MCAP or CSV) into `out`, an .svg or .png file. Needs gnuplot.
int log_plot(const std::string& path, const std::string& out, const LogPlotOptions& options = {});

/// `erp log effort`: prints tensions and energy of each muscle, and the total energy.
int log_effort(const std::string& path, double from_s, std::ostream& out);

}  // namespace launch
