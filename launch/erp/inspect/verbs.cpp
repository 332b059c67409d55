#include "launch/erp/verbs/verbs.hpp"

#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "interfaces/graph/graph.hpp"
#include "launch/erp/inspect/check.hpp"
#include "launch/erp/inspect/doctor.hpp"
#include "launch/erp/inspect/graph_view.hpp"
#include "launch/erp/inspect/reference.hpp"
#include "launch/erp/inspect/topic_view.hpp"
#include "launch/erp/run/program.hpp"
#include "launch/erp/text/duration.hpp"
#include "launch/erp/verbs/completion.hpp"
#include "launch/erp/verbs/component_check.hpp"
#include "launch/erp/verbs/man_page.hpp"
#include "launch/erp/verbs/verb_parts.hpp"

namespace launch {

void add_check(CLI::App& app, Chosen& chosen) {
  auto* verb =
      app.add_subcommand("check", "Check robot, graph and config files and print all errors");
  auto files = std::make_shared<std::vector<std::string>>();
  auto schema = std::make_shared<std::string>();
  auto* files_option =
      verb->add_option("files", *files, "XML files; for a graph, also the files that it names");
  verb->add_option("--schema", *schema, "print the XSD of robot or graph instead of checking files")
      ->excludes(files_option);
  verb->callback([files, schema, &chosen] {
    chosen = [files, schema] {
      if (!schema->empty()) return print_schema(*schema, std::cout), 0;
      if (files->empty()) throw std::invalid_argument("check: name at least one file");
      const auto find = [](const std::string& type) { return find_program(type, "."); };
      return check(*files, std::cout, check_by_program(find));
    };
  });
}

/// The parameters of a component of erp, or of a component given by the path of its program.
/// nullopt if there is no such program.
static std::optional<std::string> describe_by_program(const std::string& type) {
  const auto erp_components = component_names();
  const bool is_known =
      std::find(erp_components.begin(), erp_components.end(), type) != erp_components.end();
  if (!is_known && type.find('/') == type.npos) return std::nullopt;
  const std::string program = find_program(type, ".");
  if (program.empty()) return std::nullopt;
  return describe_component(program);
}

/// Prints the help of a verb, or the reference of a format or component. `graph` is both a verb and
/// a format; the format takes precedence.
static void print_help(const CLI::App& app, const std::string& name, std::ostream& out) {
  if (name.empty()) return list_references(out);
  if (name != erp::Graph::element)
    for (const auto* verb : app.get_subcommands([](const CLI::App*) { return true; }))
      if (verb->get_name() == name) {
        out << verb->help(app.get_name());
        return;
      }
  print_reference(name, describe_by_program, out);
}

void add_help(CLI::App& app, Chosen& chosen) {
  auto* verb =
      app.add_subcommand("help", "Explain an XML format, the parameters of a component, or a verb");
  struct Options {
    std::string name, shell;
    bool man = false;
  };
  auto options = std::make_shared<Options>();
  auto* name =
      verb->add_option("name", options->name,
                       "robot, graph, a component or its program, a verb (default: list all)");
  verb->add_flag("--man", options->man, "print the manual page of erp")->excludes(name);
  verb->add_option("--completion", options->shell, "print the completion script of a shell: bash")
      ->excludes(name)
      ->check(CLI::IsMember({"bash"}).description(""));
  verb->callback([options, &app, &chosen] {
    chosen = [options, &app] {
      if (options->man) print_man_page(app, std::cout);
      else if (!options->shell.empty()) print_bash_completion(app, std::cout);
      else print_help(app, options->name, std::cout);
      return 0;
    };
  });
}

void add_doctor(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand(
      "doctor", "Check whether this computer can run a robot: bus, real time, CAN, clocks, disk");
  auto robot = std::make_shared<std::string>();
  verb->add_option("robot", *robot, "robot.xml whose CAN bit rates are compared");
  verb->callback([robot, &chosen] { chosen = [robot] { return doctor(*robot, std::cout); }; });
}

void add_graph_view(CLI::App& app, Chosen& chosen) {
  app.add_subcommand("ps", "List components on the bus: state, rate, age of their input, jitter")
      ->callback([&chosen] { chosen = [] { return show_components(std::cout); }; });
  app.add_subcommand("ls", "List topics on the bus: type, writers, readers")->callback([&chosen] {
    chosen = [] { return show_topics(std::cout); };
  });
  auto* graph = app.add_subcommand(
      "graph", "Print the running graph in DOT, for graphviz: erp graph | dot -Tsvg");
  auto all = std::make_shared<bool>(false);
  graph->add_flag("--all", *all, "include heartbeats, lifecycle, events and the tools of erp");
  graph->callback([all, &chosen] { chosen = [all] { return show_graph(*all, std::cout); }; });
}

static void add_topic_verb(CLI::App& app, Chosen& chosen, const char* name, const char* help,
                           int (*view)(const TopicViewOptions&, std::ostream&),
                           bool has_message_count) {
  auto* verb = app.add_subcommand(name, help);
  auto options = std::make_shared<TopicViewOptions>();
  auto duration = std::make_shared<std::string>();
  verb->add_option("topic", options->topic, "topic, as listed by erp ls")->required();
  verb->add_option("--for", *duration, "duration: 20s, 500ms, 2min … (default: until Ctrl-C)");
  if (has_message_count)
    verb->add_option("-n", options->messages, "number of messages to print (default: until Ctrl-C)")
        ->check(above_zero());
  verb->callback([options, duration, view, &chosen] {
    chosen = [options, duration, view] {
      if (!duration->empty()) options->for_s = parse_duration_s(*duration);
      return view(*options, std::cout);
    };
  });
}

void add_topic_view(CLI::App& app, Chosen& chosen) {
  add_topic_verb(app, chosen, "hz", "Print rate of a topic and quantiles of its intervals",
                 show_rate, false);
  add_topic_verb(app, chosen, "echo", "Print messages of a topic as YAML", echo, true);
  add_topic_verb(app, chosen, "delay", "Print age of messages of a topic on arrival", show_delay,
                 false);
}

}  // namespace launch
