#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <memory>
#include <system_error>

#include "launch/erp/gap/blind.hpp"
#include "launch/erp/gap/gap.hpp"
#include "launch/erp/run/program.hpp"
#include "launch/erp/verbs/former_names.hpp"
#include "launch/erp/verbs/verb_parts.hpp"
#include "launch/erp/verbs/verbs.hpp"

namespace launch {
namespace {

void add_where(CLI::App& gap, Chosen& chosen) {
  auto robot = std::make_shared<std::string>();
  auto recordings = std::make_shared<std::vector<std::string>>();
  auto* where = gap.add_subcommand(
      "where",
      "Locate the gap: stages (motor, gearbox, tendon, joint) whose residual exceeds the noise");
  where->footer(
      "Exit codes: 0 evaluated, with or without a gap; 5 too little motion to evaluate any stage;\n"
      "1 failed; 2 bad usage or input, or no column from which a stage can be evaluated.");
  where->add_option("--robot", *robot, "robot.xml, the model")->required();
  where->add_option("--real", *recordings, "recordings of the robot, MCAP or CSV")->required();
  where->callback([=, &chosen] {
    chosen = [=] { return gap::where(*robot, *recordings, std::cout, std::cerr); };
  });
}

void add_diagnose(CLI::App& gap, Chosen& chosen) {
  auto options = std::make_shared<gap::DiagnoseOptions>();
  options->threads = all_cores();
  auto* diagnose = gap.add_subcommand("diagnose",
                                      "Locate the gap, identify the effect that causes it, and "
                                      "report how much of the gap it closes");
  diagnose->footer(
      "Exit codes: 0 supported by held-out recordings, 3 no gap, 4 none of the known effects,\n"
      "5 not identifiable from these recordings; 1 failed, 2 bad usage or input.");
  diagnose->add_option("--robot", options->robot, "robot.xml, the model")->required();
  diagnose->add_option("--real", options->recordings, "recordings of the robot, MCAP or CSV")
      ->required();
  diagnose->add_option(
      "--train", options->train,
      "recordings for choosing and fitting effects; default: two thirds of --real");
  diagnose->add_option(
      "--held-out", options->held_out,
      "recordings for validation; default: the third of --real with the largest signal range");
  diagnose->add_option("--withhold", options->withhold, "effect types to exclude");
  diagnose->add_option("--out", options->out,
                       "folder for report.html, diagnosis.json and, if supported, robot.xml");
  diagnose->add_option("--threads", options->threads, "number of threads; default: all cores")
      ->check(above_zero());
  diagnose->add_flag_callback(
      "--no-free-run", [options] { options->free_run = false; },
      "skip the free-run simulation of the answer");
  diagnose->add_option("--seed", options->seed, "seed of the bootstrap");
  diagnose->callback(
      [=, &chosen] { chosen = [=] { return gap::diagnose(*options, std::cout, std::cerr); }; });
}

void add_gap_calibrate(CLI::App& gap, Chosen& chosen) {
  auto options = std::make_shared<gap::CalibrateOptions>();
  options->threads = all_cores();
  auto* calibrate = gap.add_subcommand(
      "calibrate", "Estimate all constants of a robot from recordings and write its robot.xml");
  calibrate->footer(
      "Exit codes: 0 estimated, also if residuals above the noise remain;\n"
      "5 too little motion to evaluate any stage; 1 failed, 2 bad usage or input.");
  calibrate->add_option("--robot", options->robot, "robot.xml, the model")->required();
  calibrate->add_option("--real", options->recordings, "recordings of the robot, MCAP or CSV")
      ->required();
  calibrate->add_option("--out", options->out,
                        "file for the robot.xml with the estimated constants");
  calibrate->add_option("--threads", options->threads, "number of threads; default: all cores")
      ->check(above_zero());
  calibrate->add_option("--seed", options->seed, "seed of the noise floors");
  calibrate->callback(
      [=, &chosen] { chosen = [=] { return gap::calibrate(*options, std::cout, std::cerr); }; });
}

void add_plan(CLI::App& gap, Chosen& chosen) {
  auto options = std::make_shared<gap::PlanOptions>();
  options->threads = all_cores();
  auto* plan = gap.add_subcommand(
      "plan", "Plan the next recording: the motion that best distinguishes the equivalent effects");
  plan->footer(
      "Exit codes: 0 written; 1 nothing to distinguish, no safe motion, or failed; 2 bad usage or "
      "input; 5 no motion distinguishes them.");
  plan->add_option("--robot", options->robot, "robot.xml, the model")->required();
  plan->add_option("--diagnosis", options->diagnosis, "diagnosis.json of erp gap diagnose")
      ->required();
  plan->add_option("--out", options->out, "folder for the graph to launch")->required();
  plan->add_option("--seconds", options->seconds, "length of the recording; default: 20")
      ->check(CLI::Range(2.0, 600.0));
  plan->add_option("--candidates", options->candidates,
                   "number of motions to simulate; default: 24")
      ->check(above_zero());
  plan->add_option("--margin", options->to_stop_rad,
                   "smallest distance of hinges from their stops, in rad; default: 0.05")
      ->check(CLI::Range(0.0, 3.0));
  plan->add_option("--threads", options->threads, "number of threads; default: all cores")
      ->check(above_zero());
  plan->add_option("--seed", options->seed, "seed of the candidates");
  plan->callback(
      [=, &chosen] { chosen = [=] { return gap::plan(*options, std::cout, std::cerr); }; });
}

void add_confounder_options(CLI::App& verb, Chosen& chosen) {
  auto options = std::make_shared<gap::IndistinguishableOptions>();
  options->threads = all_cores();
  verb.footer(
      "Exit codes: 0 listed, 5 recordings too short to evaluate any stage; 1 failed, 2 bad usage "
      "or input.");
  verb.add_option("--robot", options->robot, "robot.xml, the model")->required();
  verb.add_option("--real", options->recordings,
                  "recordings of the robot; default: four simulated ones");
  verb.add_option("--without", options->without, "signals to ignore")
      ->check(CLI::IsMember({"tension", "current", "joint"}));
  verb.add_option("--seconds", options->seconds, "length of each simulated recording; default: 20")
      ->check(CLI::Range(2.0, 600.0));
  verb.add_option("--share", options->share,
                  "largest share of an effect that may remain unexplained; default: 0.1")
      ->check(CLI::Range(0.0, 1.0));
  verb.add_option("--max-effects", options->max_effects,
                  "largest number of effects whose sum replaces one; default: 1")
      ->check(CLI::Range(1, 9));
  add_former_option(verb, "--together", "--max-effects");
  verb.add_option("--withhold", options->withhold, "effect types to exclude");
  verb.add_option("--threads", options->threads, "number of threads; default: all cores")
      ->check(above_zero());
  verb.callback([=, &chosen] {
    chosen = [=] { return gap::list_indistinguishable(*options, std::cout, std::cerr); };
  });
}

void add_confounders(CLI::App& gap, Chosen& chosen) {
  const char* purpose = "List effects that the sensors of a robot cannot distinguish";
  add_confounder_options(*gap.add_subcommand("confounders", purpose), chosen);
  auto* former = gap.add_subcommand("twins", purpose);
  mark_former_verb(*former, "confounders");
  add_confounder_options(*former, chosen);
}

void add_blind(CLI::App& gap, Chosen& chosen) {
  auto* blind = gap.add_subcommand("blind", "Measure the diagnosis on robots with hidden effects");
  blind->require_subcommand(1);
  auto options = std::make_shared<gap::BlindMakeOptions>();
  options->threads = all_cores();
  auto* make = blind->add_subcommand(
      "make", "Draw and record cases; write the truth to a separate file, protected by its hash");
  make->add_option("--robot", options->robot, "robot.xml, the model")->required();
  make->add_option("--out", options->out, "folder for the cases")->required();
  make->add_option("--truth", options->truth, "file for the hidden effects")->required();
  make->add_option("--kind", options->kind, "hidden effects of a case; default: single")
      ->check(CLI::IsMember({"single", "null", "pair", "outside", "withheld", "many"}));
  make->add_option("--only", options->only, "effect types that may be hidden; default: all");
  make->add_option("--cases", options->cases, "number of cases; default: 10")->check(above_zero());
  make->add_option("--recordings", options->recordings, "recordings per case; default: 4")
      ->check(above_zero());
  make->add_option("--seconds", options->seconds, "length of a recording; default: 10")
      ->check(CLI::Range(2.0, 600.0));
  make->add_option("--tolerance", options->tolerance,
                   "relative standard deviation of the error of every physical constant, at most "
                   "0.2; default: 0")
      ->check(CLI::Range(0.0, 0.2));
  make->add_option("--seed", options->seed,
                   "seed of the first case, increased by 1 per case; default: 1");
  make->add_option("--without", options->without, "signals to leave out")
      ->check(CLI::IsMember({"tension", "current", "joint"}));
  make->add_option("--threads", options->threads, "number of threads; default: all cores")
      ->check(above_zero());
  make->callback(
      [=, &chosen] { chosen = [=] { return gap::blind_make(*options, std::cout, std::cerr); }; });

  auto run_options = std::make_shared<gap::BlindRunOptions>();
  run_options->threads = all_cores();
  auto* run = blind->add_subcommand(
      "run", "Diagnose the cases of a folder; under mpirun each process takes a part");
  run->add_option("folder", run_options->folder, "output folder of erp gap blind make")->required();
  run->add_flag("--free-run", run_options->free_run, "also simulate each answer as a free run");
  run->add_option("--threads", run_options->threads, "number of threads; default: all cores")
      ->check(above_zero());
  run->callback([=, &chosen] {
    chosen = [=] { return gap::blind_run(*run_options, std::cout, std::cerr); };
  });

  auto folder = std::make_shared<std::string>();
  auto truth = std::make_shared<std::string>();
  auto* score = blind->add_subcommand(
      "score", "Compare the diagnoses with the truth; print success rates and failures");
  score->footer(
      "Exit codes: 0 scored, 5 some cases are not diagnosed; 1 failed, 2 bad usage or input.");
  score->add_option("folder", *folder, "folder with diagnoses")->required();
  score->add_option("--truth", *truth, "truth file of erp gap blind make")->required();
  score->callback(
      [=, &chosen] { chosen = [=] { return gap::blind_score(*folder, *truth, std::cout); }; });
}

/// Replaces this process by the component. Throws std::system_error on failure.
[[noreturn]] void execute(const std::string& program, std::vector<std::string> words) {
  const std::string file = find_program(program, ".");
  words.insert(words.begin(), file);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(file.c_str(), argv.data());
  throw std::system_error(errno, std::generic_category(), program + " cannot be started");
}

void add_monitor(CLI::App& gap, Chosen& chosen) {
  auto* monitor = gap.add_subcommand(
      "monitor",
      "Monitor a running robot: report stages whose residual exceeds the noise (gap_monitor)");
  monitor->set_help_flag();  // the component parses --help and all other options
  monitor->prefix_command();
  monitor->callback(
      [=, &chosen] { chosen = [=]() -> int { execute("gap_monitor", monitor->remaining()); }; });
}

}  // namespace

void add_gap(CLI::App& app, Chosen& chosen) {
  auto* gap =
      app.add_subcommand("gap", "Find where a robot differs from its model, why, and by how much");
  gap->require_subcommand(1);
  add_where(*gap, chosen);
  add_diagnose(*gap, chosen);
  add_gap_calibrate(*gap, chosen);
  add_plan(*gap, chosen);
  add_confounders(*gap, chosen);
  add_monitor(*gap, chosen);
  add_blind(*gap, chosen);
}

}  // namespace launch
