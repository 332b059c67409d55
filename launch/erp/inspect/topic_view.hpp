#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

/// Views of one topic of any type. They end after a number of messages, a duration, or at Ctrl-C.
namespace launch {

struct TopicViewOptions {
  std::string topic;
  long messages = 0;  ///< `echo -n`: end after this number; 0: no limit
  double for_s = 0;   ///< end after this duration; 0: no limit
};

/// `erp echo`: every message as YAML, separated by `---`.
int echo(const TopicViewOptions& options, std::ostream& out);
/// `erp hz`: once per second, the rate and the quantiles of the intervals between arrivals.
int show_rate(const TopicViewOptions& options, std::ostream& out);
/// `erp delay`: once per second, the quantiles of the age of messages on arrival: now − stamp_ns.
int show_delay(const TopicViewOptions& options, std::ostream& out);

}  // namespace launch
