#include "launch/erp/verbs/verbs.hpp"

#include <iostream>
#include <memory>
#include <stdexcept>

#include "launch/erp/inspect/check.hpp"
#include "launch/erp/inspect/listen.hpp"
#include "launch/erp/inspect/look.hpp"
#include "launch/erp/run/program.hpp"
#include "launch/erp/text/duration.hpp"
#include "launch/erp/verbs/verb_parts.hpp"

namespace launch {

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

}  // namespace launch
