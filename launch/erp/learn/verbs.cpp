#include <iostream>
#include <memory>

#include "launch/erp/learn/learn.hpp"
#include "launch/erp/run/signals.hpp"
#include "launch/erp/verbs/verb_parts.hpp"
#include "launch/erp/verbs/verbs.hpp"

namespace launch {
namespace {

/// Options of every training.
void add_training_options(CLI::App* verb, TrainingRunOptions& training) {
  training.threads = all_cores();
  verb->add_option("--out", training.folder, "folder for the results and figures")->required();
  verb->add_option("--threads", training.threads, "default: all cores")->check(above_zero());
  verb->add_flag("--resume", training.resume, "continue the run in the folder");
}

/// Makes the verb call `learn`. Ctrl-C stops the training after a checkpoint.
template <class Options>
void set_callback(CLI::App* verb, std::shared_ptr<Options> options,
                  int (*learn)(const Options&, std::ostream&, std::ostream&), Chosen& chosen) {
  verb->callback([=, &chosen] {
    chosen = [=] {
      const auto signals = std::make_shared<Signals>();
      options->training.interrupted = [signals] { return signals->take() != 0; };
      return learn(*options, std::cout, std::cerr);
    };
  });
}

void add_sensorimotor(CLI::App& learn, Chosen& chosen) {
  auto options = std::make_shared<SensorimotorOptions>();
  auto* verb = learn.add_subcommand(
      "sensorimotor", "Learn reaching in a camera image, from twitches and trials (paper, 5.4)");
  verb->add_option("--robot", options->robot, "robot.xml")->required();
  verb->add_option("--experiment", options->experiment,
                   "<sensorimotor view=\"…\">: goals, trials …")
      ->required();
  verb->add_option("--seed", options->seed, "default: the experiment's")->check(above_zero());
  add_training_options(verb, options->training);
  set_callback(verb, options, learn_sensorimotor, chosen);
}

/// Adds the options of a training that a task file describes, with tests on new targets.
template <class Options>
void add_tested_training(CLI::App* verb, int (*learn)(const Options&, std::ostream&, std::ostream&),
                         const std::string& task, const std::string& tests, Chosen& chosen) {
  auto options = std::make_shared<Options>();
  verb->add_option("--robot", options->robot, "robot.xml")->required();
  verb->add_option("--task", options->task, task)->required();
  verb->add_option("--tests", options->tests, tests)
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--seed", options->seed, "default: the task's")->check(above_zero());
  add_training_options(verb, options->training);
  set_callback(verb, options, learn, chosen);
}

void add_goals(CLI::App& learn, Chosen& chosen) {
  auto robot = std::make_shared<std::string>(), experiment = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  auto draw = std::make_shared<sim::simulated_training::GoalDraw>();
  auto* verb = learn.add_subcommand(
      "goals", "Print an experiment's file with reachable goals, found by random muscle forces");
  verb->add_option("--robot", *robot, "robot.xml")->required();
  verb->add_option("--experiment", *experiment, "<sensorimotor view=\"…\">")->required();
  verb->add_option("--count", draw->count)->capture_default_str()->check(above_zero());
  verb->add_option("--muscles", draw->muscles, "number of muscles that pull for each goal")
      ->capture_default_str()
      ->check(above_zero());
  verb->add_option("--most", draw->most_N, "largest force above rest, N")
      ->capture_default_str()
      ->check(above_zero());
  verb->add_option("--seed", draw->seed, "seed of the random numbers")->capture_default_str();
  verb->add_option("--out", *out, "file to write; default: standard output");
  verb->callback([=, &chosen] {
    chosen = [=] {
      return write_output(*out, [=](std::ostream& to) {
        return learn_goals(*robot, *experiment, *draw, all_cores(), to);
      });
    };
  });
}

}  // namespace

void add_learn(CLI::App& app, Chosen& chosen) {
  auto* learn = app.add_subcommand("learn", "Train controllers in the simulator");
  learn->require_subcommand(1);
  learn->footer(
      "Exit codes: 0 done, 1 interrupted (continue with --resume), 2 bad usage or input.");
  add_sensorimotor(*learn, chosen);
  add_tested_training(
      learn->add_subcommand("experience",
                            "Learn reaching from stored experiences, with feedback (paper, 5.6)"),
      learn_experience, "<acquisition>: hand, zone, patterns …",
      "number of test targets, each with every kind of feedback", chosen);
  add_tested_training(
      learn->add_subcommand(
          "synergy", "Learn motor plans that strike a bottle, by reinforcement (paper, 5.5)"),
      learn_synergy, "<striking>: hand, zone, bottle, muscles …",
      "number of test targets for each size of the bank", chosen);
  add_goals(*learn, chosen);
}

}  // namespace launch
