#include "components/node/options.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>

namespace node {

Options parse_options(int argc, char** argv, const std::string& parameters, int& exit_code) {
  Options options;
  options.type = std::filesystem::path(argv[0]).filename().string();
  std::vector<std::string> settings;
  bool describe = false;
  CLI::App app(options.type + ": a component of a robot graph", options.type);
  app.footer(parameters.empty() ? "" : "Parameters, for --config and --set:\n" + parameters);
  app.add_option("--name", options.name,
                 "component name in the graph (default: the program's name)");
  app.add_option("--robot", options.robot, "robot.xml of the robot; required");
  app.add_option("--config", options.config, "XML file with the parameters");
  app.add_option("--set", settings, "key=value; overrides one parameter")->allow_extra_args(false);
  const std::map<std::string, erp::Time> times{{"realtime", erp::Time::realtime},
                                               {"lockstep", erp::Time::lockstep},
                                               {"wall", erp::Time::wall}};
  app.add_option("--time", options.time, "realtime, lockstep or wall")
      ->transform(CLI::CheckedTransformer(times).description(""))
      ->type_name("TIME")
      ->default_str("realtime");
  app.add_flag("--managed", options.managed, "stay inactive until the launcher activates it");
  app.add_option("--duration", options.duration_s, "devices: end after this time, in s (0: never)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--priority", options.priority, "controllers: the highest number takes control");
  app.add_flag("--check", options.check, "check --config and --set, then exit");
  app.add_flag("--describe", describe, "print the table of parameters alone, then exit");
  exit_code = -1;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    exit_code = app.exit(error) == 0 ? 0 : 2;
    return options;
  }
  if (describe) {
    std::fputs(parameters.c_str(), stdout);
    exit_code = 0;
    return options;
  }
  for (const auto& setting : settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0) {
      std::fprintf(stderr, "--set %s: expected key=value\n", setting.c_str());
      exit_code = 2;
      return options;
    }
    options.settings.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
  }
  if (options.name.empty()) options.name = options.type;
  return options;
}

}  // namespace node
