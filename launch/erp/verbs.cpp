#include "launch/erp/verbs.hpp"

#include <iostream>
#include <memory>
#include <stdexcept>

#include "launch/erp/check.hpp"
#include "launch/erp/duration.hpp"
#include "launch/erp/launch.hpp"
#include "launch/erp/listen.hpp"
#include "launch/erp/look.hpp"
#include "launch/erp/new_controller.hpp"
#include "launch/erp/program.hpp"
#include "launch/erp/security.hpp"
#include "launch/erp/verb_parts.hpp"

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

void add_check(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand("check", "Find every mistake in robot, graph and config files");
  auto files = std::make_shared<std::vector<std::string>>();
  auto schema = std::make_shared<std::string>();
  auto* named = verb->add_option("files", *files, "XML files; a graph brings what it names");
  verb->add_option("--schema", *schema, "print the XSD of robot or graph instead")->excludes(named);
  verb->callback([files, schema, &chosen] {
    chosen = [files, schema] {
      if (!schema->empty()) return print_schema(*schema, std::cout), 0;
      if (files->empty()) throw std::invalid_argument("check: name at least one file");
      const auto find = [](const std::string& type) { return find_program(type, "."); };
      return check(*files, std::cout, ask_program(find));
    };
  });
}

void add_look(CLI::App& app, Chosen& chosen) {
  app.add_subcommand("ps", "Components on the bus: state, rate, age of their input, jitter")
      ->callback([&chosen] { chosen = [] { return show_components(std::cout); }; });
  app.add_subcommand("ls", "Topics on the bus: type, who writes, who reads")->callback([&chosen] {
    chosen = [] { return show_topics(std::cout); };
  });
  auto* graph =
      app.add_subcommand("graph", "The running graph in DOT, for graphviz: erp graph | dot -Tsvg");
  auto all = std::make_shared<bool>(false);
  graph->add_flag("--all", *all, "with heartbeats, lifecycle, events and the tools of erp");
  graph->callback([all, &chosen] { chosen = [all] { return show_graph(*all, std::cout); }; });
}

static void add_one_listen(CLI::App& app, Chosen& chosen, const char* name, const char* help,
                           int (*listen)(const ListenOptions&, std::ostream&),
                           bool counts_messages) {
  auto* verb = app.add_subcommand(name, help);
  auto options = std::make_shared<ListenOptions>();
  auto duration = std::make_shared<std::string>();
  verb->add_option("topic", options->topic, "any topic of erp ls")->required();
  verb->add_option("--for", *duration, "end after 20s, 500ms, 2min … (default: at Ctrl-C)");
  if (counts_messages)
    verb->add_option("-n", options->messages, "end after so many messages")->check(above_zero());
  verb->callback([options, duration, listen, &chosen] {
    chosen = [options, duration, listen] {
      if (!duration->empty()) options->for_s = parse_duration_s(*duration);
      return listen(*options, std::cout);
    };
  });
}

void add_listen(CLI::App& app, Chosen& chosen) {
  add_one_listen(app, chosen, "hz", "Rate of a topic and spread of its intervals", show_rate,
                 false);
  add_one_listen(app, chosen, "echo", "Messages of a topic as YAML", echo, true);
  add_one_listen(app, chosen, "delay", "Age of a topic's messages on arrival", show_delay, false);
}

void add_new(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand("new", "Begin something of your own");
  verb->require_subcommand(1);
  auto* controller = verb->add_subcommand("controller", "A project of one controller, with a test");
  auto name = std::make_shared<std::string>();
  auto folder = std::make_shared<std::string>();
  controller->add_option("name", *name, "lower-case words joined by _")->required();
  controller->add_option("dir", *folder, "a folder that is not there yet")->required();
  controller->callback([name, folder, &chosen] {
    chosen = [name, folder] {
      for (const auto& file : new_controller(*name, *folder)) std::cout << file.string() << '\n';
      std::cout << "next: cd " << *folder
                << " && cmake -B build -DCMAKE_PREFIX_PATH=<where erp is installed>"
                   " && cmake --build build && ctest --test-dir build\n";
      return 0;
    };
  });
}

void add_security(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand("security", "Who may drive a robot, and listen to it");
  verb->require_subcommand(1);
  auto* make = verb->add_subcommand("make", "An authority of your own, and an identity of its");
  auto folder = std::make_shared<std::string>();
  auto days = std::make_shared<int>(730);
  make->add_option("dir", *folder, "a folder that is not there yet")->required();
  make->add_option("--days", *days, "how long its certificates are valid")
      ->check(CLI::Range(1, 36500))
      ->capture_default_str();
  make->callback([folder, days, &chosen] {
    chosen = [folder, days] {
      for (const auto& file : make_security(*folder, valid_for_days(*days)))
        std::cout << file.string() << '\n';
      std::cout << "next: erp launch GRAPH.xml --security " << *folder
                << "; in other terminals: export ERP_SECURITY=" << *folder << '\n';
      return 0;
    };
  });
}

}  // namespace launch
