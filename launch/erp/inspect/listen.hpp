#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

/// Verbs that listen to one topic, of whatever type, until they have heard enough or Ctrl-C.
namespace launch {

struct ListenOptions {
  std::string topic;
  long messages = 0;  ///< `echo -n`: end after so many; 0: never
  double for_s = 0;   ///< end after so long; 0: never
};

/// `erp echo`: every message as YAML, `---` between them.
int echo(const ListenOptions& options, std::ostream& out);
/// `erp hz`: each second the rate and the spread of the intervals between arrivals.
int show_rate(const ListenOptions& options, std::ostream& out);
/// `erp delay`: each second the ages of the messages on arrival, now − stamp_ns.
int show_delay(const ListenOptions& options, std::ostream& out);

}  // namespace launch
