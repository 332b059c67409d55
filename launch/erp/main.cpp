#include <algorithm>
#include <iostream>
#include <stdexcept>

#include "interfaces/recording/error.hpp"
#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/words.hpp"
#include "launch/erp/verbs/verbs.hpp"

namespace launch {

// Defined in a file that revision.cmake writes.
const char* version();   ///< version of the project, "0.2.0"
const char* revision();  ///< git revision, with "-dirty" after uncommitted changes; or "unknown"

namespace {

void add_verbs(CLI::App& app, Chosen& chosen) {
  add_launch(app, chosen);
  add_check(app, chosen);
  add_help(app, chosen);
  add_doctor(app, chosen);
  add_command(app, chosen);
  add_graph_view(app, chosen);
  add_topic_view(app, chosen);
  add_log(app, chosen);
  add_model(app, chosen);
  add_gap(app, chosen);
  add_calibrate(app, chosen);
  add_learn(app, chosen);
  add_new(app, chosen);
  add_security(app, chosen);
}

struct Family {
  const char* purpose;
  std::vector<const char*> verbs;
};

/// The verbs by purpose, as `erp` without a verb lists them.
const std::vector<Family> families{
    {"Run a robot, simulated or real", {"launch", "check", "doctor", "help"}},
    {"Command a running robot", {"home", "send", "set", "stop"}},
    {"Inspect a running graph", {"ps", "ls", "graph", "hz", "echo", "delay"}},
    {"Evaluate recordings", {"log"}},
    {"Describe and calibrate a robot", {"model", "calibrate"}},
    {"Diagnose the gap between a robot and its model", {"gap"}},
    {"Train controllers", {"learn"}},
    {"Write a controller, secure the bus", {"new", "security"}},
};

void group_by_purpose(CLI::App& app) {
  for (const auto& [purpose, verbs] : families)
    for (const auto* verb : verbs) app.get_subcommand(verb)->group(purpose);
}

/// Returns true for an unknown verb and prints the most similar verb. CLI11 would report only an
/// unexpected argument.
bool is_unknown_verb(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  std::vector<std::string> verbs;
  for (const auto* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
  if (std::find(verbs.begin(), verbs.end(), argv[1]) != verbs.end()) return false;
  std::cerr << "erp: unknown verb \"" << argv[1] << "\"; " << xml::did_you_mean(argv[1], verbs)
            << '\n';
  return true;
}

int fail(const std::exception& error, int code) {
  std::cerr << "erp: " << error.what() << '\n';
  return code;
}

int execute(const Chosen& chosen) {
  try {
    return chosen();
  } catch (const xml::Errors& error) {
    std::cerr << error.what() << '\n';
    return 2;
  } catch (const recording::WriteError& error) {
    return fail(error, 1);
  } catch (const recording::RecordingError& error) {
    return fail(error, 2);
  } catch (const std::invalid_argument& error) {
    return fail(error, 2);
  } catch (const std::exception& error) {
    return fail(error, 1);
  }
}

/// Parses the command line of `erp` and executes its verb.
/// Exit codes: 0 done, 1 failed, 2 bad usage or input.
int run_command_line(int argc, char** argv) {
  CLI::App app("Runs and inspects graphs of components that control a tendon-driven robot.", "erp");
  Chosen chosen;
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("erp ") + version() + " (" + revision() + ")");
  app.footer(
      "Exit codes: 0 done, 1 failed, 2 bad usage or input. ERP_DOMAIN=0…230 separates graphs. "
      "ERP_SECURITY=DIR: DDS Security with the certificate in DIR (see erp security make).");
  add_verbs(app, chosen);
  group_by_purpose(app);
  if (argc < 2) {
    std::cout << app.help() << "\nerp VERB --help: options and examples of a verb\n";
    return 0;
  }
  if (is_unknown_verb(app, argc, argv)) return 2;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return execute(chosen);
}

}  // namespace
}  // namespace launch

int main(int argc, char** argv) { return launch::run_command_line(argc, argv); }
