// A component for the tests of the launcher. Built as `sim`, which publishes the clock and ends the
// run, and as `plant`, `logger` and `worker`, which subscribe to the clock. The parameter `fault`
// makes it fail.
#include <unistd.h>

#include <csignal>

#include "components/node/run.hpp"

namespace {

enum class Fault { none, crash, refuse, hang };

struct Params {
  Fault fault = Fault::none;
  int crash_after_steps = 0;
  std::string file, attach, bus;  // parameters that the launcher sets for a logger and a device
  void visit(auto& v) {
    v("fault", fault);
    v("crash_after_steps", crash_after_steps);
    v("file", file), v("attach", attach), v("bus", bus);
  }
};

class Component {
 public:
  using Params = ::Params;

  Component(const Params& params, const erp::Robot&, node::Node& node)
      : params_(params), node_(node) {
    if (params.fault == Fault::refuse) throw std::invalid_argument("fault must be none");
    if (params.fault == Fault::crash) throw std::runtime_error("crash requested by fault=crash");
    if (node.options().type == "sim") publish_clock();
    else node.subscribe<erp::Clock>([this](const erp::Clock& clock) { step(clock.stamp_ns); });
    node.on_activate([this] { report_active(); });
    node.on_deactivate([this] {
      while (params_.fault == Fault::hang) pause();
    });
  }

 private:
  static constexpr std::int64_t period_ns = 10'000'000;

  void publish_clock() {
    clock_out_ = &node_.advertise<erp::Clock>();
    node_.every(period_ns, [this] {
      clock_.stamp_ns += period_ns;
      clock_.real_time_factor = 1;
      clock_out_->publish(clock_);
      const double duration_s = node_.options().duration_s;
      if (duration_s > 0 && 1e-9 * static_cast<double>(clock_.stamp_ns) >= duration_s)
        node_.finish();
    });
  }
  void step(std::int64_t stamp_ns) {
    node_.count_step(stamp_ns);
    if (params_.crash_after_steps && ++steps_ == params_.crash_after_steps) raise(SIGKILL);
  }
  void report_active() {
    node_.report(erp::Severity::info, "", "active", node_.options().name + " is up");
  }

  Params params_;
  node::Node& node_;
  node::Publisher<erp::Clock>* clock_out_ = nullptr;
  erp::Clock clock_;
  int steps_ = 0;
};

}  // namespace

template <>
struct xml::Names<Fault> {
  static constexpr auto list =
      std::to_array<std::pair<const char*, Fault>>({{"none", Fault::none},
                                                    {"crash", Fault::crash},
                                                    {"refuse", Fault::refuse},
                                                    {"hang", Fault::hang}});
};

int main(int argc, char** argv) { return node::run<Component>(argc, argv); }
