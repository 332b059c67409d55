#include "launch/erp/inspect/topic_view.hpp"

#include <cstdio>
#include <limits>
#include <ostream>

#include "components/node/clock.hpp"
#include "components/node/type_schema.hpp"
#include "launch/erp/inspect/discovery_listener.hpp"
#include "launch/erp/inspect/spread.hpp"
#include "launch/erp/inspect/yaml.hpp"
#include "launch/erp/run/status_table.hpp"

namespace launch {
namespace {

constexpr int queue_depth = 256;                   // chosen: messages that arrive during printing
constexpr std::int64_t window_ns = 1'000'000'000;  // chosen: one line per second
constexpr double day_us = 86400e6;                 // larger ages mean stamps in simulated time

/// Subscription to one discovered topic.
class Listener {
 public:
  Listener(const std::string& verb, const TopicViewOptions& options)
      : discovery_(verb),
        descriptor_(discovery_.find_type(options.topic)),
        type_(node::describe(*descriptor_)),
        reader_(discovery_.participant(), discovery_.wake(), *descriptor_, options.topic,
                queue_depth),
        duration_ns_(options.for_s > 0 ? static_cast<std::int64_t>(options.for_s * 1e9)
                                       : std::numeric_limits<std::int64_t>::max() / 2) {}

  const recording::TypeDescription& type() const { return type_; }

  /// Calls `on_sample` for each sample until it returns true, the duration has passed or a signal
  /// arrives. Calls `on_batch` after each batch of samples.
  template <class OnSample, class OnBatch>
  void for_each(OnSample&& on_sample, OnBatch&& on_batch) {
    discovery_.watch(duration_ns_, [&] {
      bool is_done = false;
      reader_.take([&](const node::RawSample& sample) {
        if (!is_done) is_done = on_sample(recording::ByteView(sample.cdr));
      });
      on_batch();
      return is_done;
    });
  }

 private:
  DiscoveryListener discovery_;
  node::Descriptor descriptor_;
  recording::TypeDescription type_;
  node::RawReader reader_;
  std::int64_t duration_ns_;
};

/// Timer that is due once per window.
class PeriodicTimer {
 public:
  bool is_due() {
    const std::int64_t now_ns = node::monotonic_ns();
    if (now_ns - last_ns_ < window_ns) return false;
    elapsed_s_ = 1e-9 * static_cast<double>(now_ns - last_ns_);
    last_ns_ = now_ns;
    return true;
  }
  double elapsed_s() const { return elapsed_s_; }

 private:
  std::int64_t last_ns_ = node::monotonic_ns();
  double elapsed_s_ = 0;
};

}  // namespace

int echo(const TopicViewOptions& options, std::ostream& out) {
  Listener listener("echo", options);
  long received = 0;
  listener.for_each(
      [&](recording::ByteView cdr) {
        out << to_yaml(recording::decode_cdr(listener.type(), cdr)) << "---\n";
        return ++received == options.messages;
      },
      [&] { out.flush(); });
  return received > 0 ? 0 : 1;
}

int show_rate(const TopicViewOptions& options, std::ostream& out) {
  Listener listener("hz", options);
  PeriodicTimer window;
  Spread intervals_us;
  std::int64_t last_ns = 0;
  std::size_t received = 0, total = 0;
  listener.for_each(
      [&](recording::ByteView) {
        const std::int64_t now_ns = node::monotonic_ns();
        if (last_ns) intervals_us.add(1e-3 * static_cast<double>(now_ns - last_ns));
        last_ns = now_ns;
        ++received, ++total;
        return false;
      },
      [&] {
        if (!window.is_due()) return;
        char rate[32];
        std::snprintf(rate, sizeof rate, "%8.1f Hz",
                      static_cast<double>(received) / window.elapsed_s());
        out << rate << "   intervals: min " << microseconds(intervals_us.quantile(0)) << ", p50 "
            << microseconds(intervals_us.quantile(0.5)) << ", p99 "
            << microseconds(intervals_us.quantile(0.99)) << ", max "
            << microseconds(intervals_us.quantile(1)) << std::endl;
        intervals_us.clear();
        received = 0;
      });
  return total > 0 ? 0 : 1;
}

int show_delay(const TopicViewOptions& options, std::ostream& out) {
  Listener listener("delay", options);
  if (!listener.type().root().find("stamp_ns"))
    throw std::invalid_argument("\"" + options.topic +
                                "\" has no field stamp_ns, so its age is unknown; use erp hz");
  PeriodicTimer window;
  Spread ages_us;
  std::size_t total = 0;
  listener.for_each(
      [&](recording::ByteView cdr) {
        const auto stamp_ns = recording::header_of(listener.type(), cdr).stamp_ns;
        if (stamp_ns) ages_us.add(1e-3 * static_cast<double>(node::wall_ns() - *stamp_ns));
        ++total;
        return false;
      },
      [&] {
        if (!window.is_due()) return;
        if (ages_us.count() == 0) out << "no message";
        else if (ages_us.quantile(0.5) > day_us)
          out << "stamps are in simulated time; their age is not defined";
        else
          out << "p50 " << microseconds(ages_us.quantile(0.5)) << ", p99 "
              << microseconds(ages_us.quantile(0.99)) << ", max "
              << microseconds(ages_us.quantile(1)) << ", " << ages_us.count() << " messages";
        out << std::endl;
        ages_us.clear();
      });
  return total > 0 ? 0 : 1;
}

}  // namespace launch
