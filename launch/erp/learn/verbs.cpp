#include <iostream>
#include <memory>

#include "launch/erp/run/signals.hpp"
#include "launch/erp/verbs/verb_parts.hpp"
#include "launch/erp/verbs/verbs.hpp"
#include "launch/erp/learn/experience.hpp"
#include "launch/erp/learn/sensorimotor.hpp"
#include "launch/erp/learn/synergy.hpp"

namespace launch {
namespace {

/// What every course has.
void add_course(CLI::App* verb, CourseOptions& course) {
  course.threads = all_cores();
  verb->add_option("--out", course.folder, "folder for what is learnt and its pictures")
      ->required();
  verb->add_option("--threads", course.threads, "default: all cores")->check(above_zero());
  verb->add_flag("--resume", course.resume, "go on with what is in the folder");
}

/// The verb's whole work, ended by Ctrl-C with all kept.
template <class Options>
void run_by(CLI::App* verb, std::shared_ptr<Options> o,
            int (*learn)(const Options&, std::ostream&, std::ostream&), Chosen& chosen) {
  verb->callback([=, &chosen] {
    chosen = [=] {
      const auto signals = std::make_shared<Signals>();
      o->course.interrupted = [signals] { return signals->take() != 0; };
      return learn(*o, std::cout, std::cerr);
    };
  });
}

void add_sensorimotor(CLI::App& learn, Chosen& chosen) {
  auto o = std::make_shared<SensorimotorOptions>();
  auto* verb = learn.add_subcommand(
      "sensorimotor", "Reaching in a camera's image, from twitches and tries (paper, 5.4)");
  verb->add_option("--robot", o->robot, "robot.xml")->required();
  verb->add_option("--experiment", o->experiment, "<sensorimotor view=\"…\">: goals, tries …")
      ->required();
  verb->add_option("--seed", o->seed, "default: the experiment's")->check(above_zero());
  add_course(verb, o->course);
  run_by(verb, o, learn_sensorimotor, chosen);
}

/// A lesson that a task describes and fresh targets test.
template <class Options>
void add_tested(CLI::App* verb, int (*learn)(const Options&, std::ostream&, std::ostream&),
                const std::string& task, const std::string& tests, Chosen& chosen) {
  auto o = std::make_shared<Options>();
  verb->add_option("--robot", o->robot, "robot.xml")->required();
  verb->add_option("--task", o->task, task)->required();
  verb->add_option("--tests", o->tests, tests)
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--seed", o->seed, "default: the task's")->check(above_zero());
  add_course(verb, o->course);
  run_by(verb, o, learn, chosen);
}

void add_goals(CLI::App& learn, Chosen& chosen) {
  auto robot = std::make_shared<std::string>(), experiment = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  auto draw = std::make_shared<sim::simulated_training::GoalDraw>();
  auto* verb = learn.add_subcommand(
      "goals", "An experiment's file with goals that can be reached: where drawn muscles lead");
  verb->add_option("--robot", *robot, "robot.xml")->required();
  verb->add_option("--experiment", *experiment, "<sensorimotor view=\"…\">")->required();
  verb->add_option("--count", draw->count)->capture_default_str()->check(above_zero());
  verb->add_option("--muscles", draw->muscles, "that pull, for each goal")
      ->capture_default_str()
      ->check(above_zero());
  verb->add_option("--most", draw->most_N, "above rest, N")
      ->capture_default_str()
      ->check(above_zero());
  verb->add_option("--seed", draw->seed, "of what is drawn")->capture_default_str();
  verb->add_option("--out", *out, "a file to write; else it is printed");
  verb->callback([=, &chosen] {
    chosen = [=] {
      return give(*out, [=](std::ostream& to) {
        return learn_goals(*robot, *experiment, *draw, all_cores(), to);
      });
    };
  });
}

}  // namespace

void add_learn(CLI::App& app, Chosen& chosen) {
  auto* learn = app.add_subcommand("learn", "Controllers that learn, in the simulator");
  learn->require_subcommand(1);
  learn->footer("Exit codes: 0 done, 1 interrupted: --resume goes on; 2 bad usage or input.");
  add_sensorimotor(*learn, chosen);
  add_tested(
      learn->add_subcommand(
          "experience", "Reaching with what was experienced, corrected by feedback (paper, 5.6)"),
      learn_experience, "<acquisition>: hand, zone, patterns …",
      "reaches to fresh targets, each way", chosen);
  add_tested(learn->add_subcommand(
                 "synergy", "Striking a bottle by motor plans, by reinforcement (paper, 5.5)"),
             learn_synergy, "<striking>: hand, zone, bottle, muscles …",
             "fresh targets, for each size of the bank", chosen);
  add_goals(*learn, chosen);
}

}  // namespace launch
