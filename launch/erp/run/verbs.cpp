#include "launch/erp/verbs/verbs.hpp"

#include <memory>

#include "launch/erp/run/launch.hpp"

namespace launch {

void add_launch(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand("launch", "Start a graph, look after it, end it in order");
  auto options = std::make_shared<LaunchOptions>();
  verb->add_option("graph", options->graph_file, "the graph's XML file")->required();
  verb->add_option("--device", options->device, "sim, can or replay:FILE, instead of the graph's");
  auto* lockstep = verb->add_flag_callback(
      "--lockstep", [options] { options->time = erp::Time::lockstep; },
      "as fast as it goes; a repetition exports the same, bit by bit");
  verb->add_flag_callback(
          "--realtime", [options] { options->time = erp::Time::realtime; },
          "at the pace of the clock")
      ->excludes(lockstep);
  verb->add_option(
      "--for", options->duration,
      "end after 20s, 500ms, 2min …; of the device's time in lockstep, else by the clock");
  verb->add_option("--set", options->settings,
                   "component.key=value: one parameter of one component; repeatable")
      ->allow_extra_args(false);
  verb->add_option("--restarts", options->most_restarts,
                   "how often within 30 s a component is started again before it is given up")
      ->capture_default_str();
  verb->add_option("--patience", options->patience,
                   "how long components may take to be ready before the launch is given up")
      ->capture_default_str();
  verb->add_option("--out", options->folder,
                   "folder for logs and recording (default: erp_runs/<graph>/<UTC time>)");
  verb->add_option("--security", options->security,
                   "folder of erp security make: nobody else is heard, or hears (ERP_SECURITY)");
  verb->footer("Ctrl-C stops the graph in order; a second one kills it.");
  verb->callback([options, &chosen] { chosen = [options] { return launch_graph(*options); }; });
}

}  // namespace launch
