#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <memory>
#include <system_error>

#include "launch/erp/gap/blind.hpp"
#include "launch/erp/gap/gap.hpp"
#include "launch/erp/run/program.hpp"
#include "launch/erp/verbs/verb_parts.hpp"
#include "launch/erp/verbs/verbs.hpp"

namespace launch {
namespace {

void add_where(CLI::App& gap, Chosen& chosen) {
  auto robot = std::make_shared<std::string>();
  auto recordings = std::make_shared<std::vector<std::string>>();
  auto* where = gap.add_subcommand(
      "where", "Which stages of the chain recordings contradict: motor, gearbox, tendon, joint");
  where->footer(
      "Exit codes: 0 judged, with a gap or without; 5 too little moves to judge anything;\n"
      "1 failed, 2 bad usage or input, also columns from which no stage can be judged.");
  where->add_option("--robot", *robot, "robot.xml, the model")->required();
  where->add_option("--real", *recordings, "recordings of the robot, MCAP or CSV")->required();
  where->callback([=, &chosen] {
    chosen = [=] { return gap::where(*robot, *recordings, std::cout, std::cerr); };
  });
}

void add_diagnose(CLI::App& gap, Chosen& chosen) {
  auto o = std::make_shared<gap::DiagnoseOptions>();
  o->threads = all_cores();
  auto* diagnose = gap.add_subcommand(
      "diagnose", "Where the gap lies, which effect causes it, how far that effect closes it");
  diagnose->footer(
      "Exit codes: 0 supported by recordings held out, 3 no gap, 4 none of the known effects,\n"
      "5 not identifiable from these recordings; 1 failed, 2 bad usage or input.");
  diagnose->add_option("--robot", o->robot, "robot.xml, the model")->required();
  diagnose->add_option("--real", o->recordings, "recordings of the robot, MCAP or CSV")->required();
  diagnose->add_option("--train", o->train,
                       "recordings to choose and fit effects by; default: most of --real");
  diagnose->add_option("--held-out", o->held_out,
                       "recordings to judge them by; default: a third of --real, the farthest off");
  diagnose->add_option("--withhold", o->withhold, "types of effects to do without");
  diagnose->add_option("--out", o->out, "folder for report.html, diagnosis.json and robot.xml");
  diagnose->add_option("--threads", o->threads, "default: all cores")->check(above_zero());
  diagnose->add_flag_callback(
      "--no-free-run", [o] { o->free_run = false; },
      "do not let the answer run freely in the simulator");
  diagnose->add_option("--seed", o->seed, "of the bootstrap");
  diagnose->callback(
      [=, &chosen] { chosen = [=] { return gap::diagnose(*o, std::cout, std::cerr); }; });
}

void add_gap_calibrate(CLI::App& gap, Chosen& chosen) {
  auto o = std::make_shared<gap::CalibrateOptions>();
  o->threads = all_cores();
  auto* calibrate = gap.add_subcommand(
      "calibrate",
      "All constants of a robot as built, from recordings: the robot.xml of this robot");
  calibrate->footer(
      "Exit codes: 0 estimated, also where stages keep more than noise;\n"
      "5 too little to judge anything; 1 failed, 2 bad usage or input.");
  calibrate->add_option("--robot", o->robot, "robot.xml, the model")->required();
  calibrate->add_option("--real", o->recordings, "recordings of the robot, MCAP or CSV")
      ->required();
  calibrate->add_option("--out", o->out, "file for the robot.xml with the constants found");
  calibrate->add_option("--threads", o->threads, "default: all cores")->check(above_zero());
  calibrate->add_option("--seed", o->seed, "of the noise floors");
  calibrate->callback(
      [=, &chosen] { chosen = [=] { return gap::calibrate(*o, std::cout, std::cerr); }; });
}

void add_plan(CLI::App& gap, Chosen& chosen) {
  auto o = std::make_shared<gap::PlanOptions>();
  o->threads = all_cores();
  auto* plan = gap.add_subcommand(
      "plan", "What to record next: the excitation that best splits what cannot be told apart");
  plan->footer(
      "Exit codes: 0 written; 1 nothing to distinguish, nothing safe, or failed; 2 bad usage or "
      "input; 5 no excitation would distinguish them.");
  plan->add_option("--robot", o->robot, "robot.xml, the model")->required();
  plan->add_option("--diagnosis", o->diagnosis, "diagnosis.json of erp gap diagnose")->required();
  plan->add_option("--out", o->out, "folder for the graph to launch")->required();
  plan->add_option("--seconds", o->seconds, "of the recording; default: 20")
      ->check(CLI::Range(2.0, 600.0));
  plan->add_option("--candidates", o->candidates, "that are rehearsed; default: 24")
      ->check(above_zero());
  plan->add_option("--margin", o->to_stop_rad,
                   "rad, that hinges keep from their stops; default: 0.05")
      ->check(CLI::Range(0.0, 3.0));
  plan->add_option("--threads", o->threads, "default: all cores")->check(above_zero());
  plan->add_option("--seed", o->seed, "of the candidates");
  plan->callback([=, &chosen] { chosen = [=] { return gap::plan(*o, std::cout, std::cerr); }; });
}

void add_twins(CLI::App& gap, Chosen& chosen) {
  auto o = std::make_shared<gap::IndistinguishableOptions>();
  o->threads = all_cores();
  auto* twins = gap.add_subcommand(
      "twins", "Which effects the sensors of a robot cannot tell apart, before anything is wrong");
  twins->footer(
      "Exit codes: 0 listed, 5 recordings too short to judge anything; 1 failed, 2 bad usage or "
      "input.");
  twins->add_option("--robot", o->robot, "robot.xml, the model")->required();
  twins->add_option("--real", o->recordings, "recordings to ask; default: four of the simulator");
  twins->add_option("--without", o->without, "signals to do without")
      ->check(CLI::IsMember({"tension", "current", "joint"}));
  twins->add_option("--seconds", o->seconds, "of each that the simulator records")
      ->check(CLI::Range(2.0, 600.0));
  twins->add_option("--share", o->share, "of an effect that another leaves, at most; default 0.1")
      ->check(CLI::Range(0.0, 1.0));
  twins->add_option("--together", o->together, "others that stand for one, at most; default 1")
      ->check(CLI::Range(1, 9));
  twins->add_option("--withhold", o->withhold, "types of effects to do without");
  twins->add_option("--threads", o->threads, "default: all cores")->check(above_zero());
  twins->callback([=, &chosen] { chosen = [=] { return gap::twins(*o, std::cout, std::cerr); }; });
}

void add_blind(CLI::App& gap, Chosen& chosen) {
  auto* blind = gap.add_subcommand("blind", "Cases with something hidden, to try the diagnosis on");
  blind->require_subcommand(1);
  auto o = std::make_shared<gap::BlindMakeOptions>();
  o->threads = all_cores();
  auto* make = blind->add_subcommand("make", "Draw and record cases; seal what they hide");
  make->add_option("--robot", o->robot, "robot.xml, the model")->required();
  make->add_option("--out", o->out, "folder for the cases")->required();
  make->add_option("--truth", o->truth, "file for what is hidden")->required();
  make->add_option("--kind", o->kind, "what cases hide; default: single")
      ->check(CLI::IsMember({"single", "null", "pair", "outside", "withheld", "many"}));
  make->add_option("--only", o->only, "types to hide; default: any");
  make->add_option("--cases", o->cases, "how many; default: 10")->check(above_zero());
  make->add_option("--recordings", o->recordings, "a case; default: 4")->check(above_zero());
  make->add_option("--seconds", o->seconds, "a recording; default: 10")
      ->check(CLI::Range(2.0, 600.0));
  make->add_option("--tolerance", o->tolerance,
                   "every physical number of the robot is off by this share of it (one standard "
                   "deviation, at most 0.2); default: 0")
      ->check(CLI::Range(0.0, 0.2));
  make->add_option("--seed", o->seed, "of the first case, the next ones follow; default: 1");
  make->add_option("--without", o->without, "signals not recorded")
      ->check(CLI::IsMember({"tension", "current", "joint"}));
  make->add_option("--threads", o->threads, "default: all cores")->check(above_zero());
  make->callback(
      [=, &chosen] { chosen = [=] { return gap::blind_make(*o, std::cout, std::cerr); }; });

  auto r = std::make_shared<gap::BlindRunOptions>();
  r->threads = all_cores();
  auto* run = blind->add_subcommand(
      "run", "Diagnose the cases of a folder; under mpirun, each process its part");
  run->add_option("folder", r->folder, "as blind make left it")->required();
  run->add_flag("--free-run", r->free_run, "each answer is also let run freely in the simulator");
  run->add_option("--threads", r->threads, "default: all cores")->check(above_zero());
  run->callback(
      [=, &chosen] { chosen = [=] { return gap::blind_run(*r, std::cout, std::cerr); }; });

  auto folder = std::make_shared<std::string>();
  auto truth = std::make_shared<std::string>();
  auto* score = blind->add_subcommand("score", "Open the truth and print rates and failures");
  score->footer(
      "Exit codes: 0 told, 5 some cases are not diagnosed; 1 failed, 2 bad usage or input.");
  score->add_option("folder", *folder, "with diagnoses")->required();
  score->add_option("--truth", *truth, "the sealed file")->required();
  score->callback(
      [=, &chosen] { chosen = [=] { return gap::blind_score(*folder, *truth, std::cout); }; });
}

/// Becomes the component. Throws std::system_error if it cannot.
[[noreturn]] void become(const std::string& program, std::vector<std::string> words) {
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
      "monitor", "Beside the running robot: tells when a stage leaves its noise (gap_monitor)");
  monitor->set_help_flag();  // that of the component, as all that follows
  monitor->prefix_command();
  monitor->callback(
      [=, &chosen] { chosen = [=]() -> int { become("gap_monitor", monitor->remaining()); }; });
}

}  // namespace

void add_gap(CLI::App& app, Chosen& chosen) {
  auto* gap = app.add_subcommand("gap", "Where a robot and its model part, why, and by how much");
  gap->require_subcommand(1);
  add_where(*gap, chosen);
  add_diagnose(*gap, chosen);
  add_gap_calibrate(*gap, chosen);
  add_plan(*gap, chosen);
  add_twins(*gap, chosen);
  add_monitor(*gap, chosen);
  add_blind(*gap, chosen);
}

}  // namespace launch
