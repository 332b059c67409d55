#include "launch/erp/verbs/verbs.hpp"

#include <memory>

#include "launch/erp/run/launch.hpp"
#include "launch/erp/verbs/former_names.hpp"

namespace launch {

void add_launch(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand("launch", "Start, supervise and stop a graph");
  auto options = std::make_shared<LaunchOptions>();
  verb->add_option("graph", options->graph_file, "XML file of the graph")->required();
  verb->add_option("--device", options->device,
                   "device: sim, can or replay:FILE (default: as in the graph)");
  auto* lockstep = verb->add_flag_callback(
      "--lockstep", [options] { options->time = erp::Time::lockstep; },
      "run as fast as possible; two runs export identical bits");
  verb->add_flag_callback(
          "--realtime", [options] { options->time = erp::Time::realtime; }, "run in real time")
      ->excludes(lockstep);
  verb->add_option("--for", options->duration,
                   "duration: 20s, 500ms, 2min …; device time in lockstep, else real time");
  verb->add_option("--set", options->settings,
                   "component.key=value: set a parameter of a component; repeatable")
      ->allow_extra_args(false);
  verb->add_option("--restarts", options->max_restarts,
                   "maximum number of restarts of one component within 30 s")
      ->capture_default_str();
  verb->add_option("--ready-timeout", options->ready_timeout,
                   "time limit until all components are ready")
      ->capture_default_str();
  add_former_option(*verb, "--patience", "--ready-timeout");
  verb->add_option("--out", options->folder,
                   "folder for logs and recording (default: erp_runs/<graph>/<UTC time>)");
  verb->add_option("--security", options->security,
                   "folder of erp security make: use DDS Security (default: ERP_SECURITY)");
  verb->footer("Ctrl-C stops the graph in order; a second Ctrl-C kills it.");
  verb->callback([options, &chosen] { chosen = [options] { return launch_graph(*options); }; });
}

}  // namespace launch
