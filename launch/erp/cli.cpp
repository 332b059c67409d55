#include "launch/erp/cli.hpp"

#include <algorithm>
#include <iostream>
#include <stdexcept>

#include "interfaces/recording/error.hpp"
#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/words.hpp"
#include "launch/erp/verbs/verbs.hpp"
#include "launch/erp/version.hpp"

namespace launch {
namespace {

void add_verbs(CLI::App& app, Chosen& chosen) {
  add_launch(app, chosen);
  add_check(app, chosen);
  add_look(app, chosen);
  add_listen(app, chosen);
  add_log(app, chosen);
  add_model(app, chosen);
  add_gap(app, chosen);
  add_calibrate(app, chosen);
  add_learn(app, chosen);
  add_new(app, chosen);
  add_security(app, chosen);
}

/// A first word that is no verb, with the nearest one; CLI11 would only say it was not expected.
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

int carry_out(const Chosen& chosen) {
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

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app("Runs and inspects graphs of components that move a tendon-driven robot.", "erp");
  Chosen chosen;
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("erp ") + version() + " (" + revision() + ")");
  app.footer(
      "Exit codes: 0 done, 1 failed, 2 bad usage or input. ERP_DOMAIN=0…230 keeps graphs "
      "apart. ERP_SECURITY=DIR: only who holds a certificate of erp security make is heard.");
  add_verbs(app, chosen);
  if (is_unknown_verb(app, argc, argv)) return 2;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return carry_out(chosen);
}

}  // namespace launch
