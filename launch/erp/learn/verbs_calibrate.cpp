#include <iostream>
#include <map>
#include <memory>

#include "launch/erp/run/signals.hpp"
#include "launch/erp/verbs/verb_parts.hpp"
#include "launch/erp/verbs/verbs.hpp"
#include "launch/erp/learn/calibrate.hpp"

namespace launch {
namespace {

void add_poses(CLI::App* verb, std::string& robot, PoseFiles& poses) {
  verb->add_option("--robot", robot, "robot.xml, the model")->required();
  verb->add_option("--real", poses.learn, "recordings of the robot, still again and again")
      ->required();
  verb->add_option("--check", poses.check,
                   "recordings whose poses only check; default: every second pose of --real");
}

void add_tour(CLI::App& calibrate, Chosen& chosen) {
  auto o = std::make_shared<TourOptions>();
  auto out = std::make_shared<std::string>();
  auto* tour = calibrate.add_subcommand(
      "tour", "What to record: each pose of a trajectory, held, and midway to the next");
  tour->add_option("lengths", o->lengths, "trajectory of line lengths, as of erp model lengths")
      ->required();
  tour->add_option("--still", o->still_s, "each is held so long, s")
      ->capture_default_str()
      ->check(CLI::Range(0.5, 600.0));
  tour->add_option("--way", o->way_s, "from one to the next, s")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 600.0));
  tour->add_option("--out", *out, "a file to write; else it is printed");
  tour->callback([=, &chosen] {
    chosen = [=] { return give(*out, [=](std::ostream& to) { return calibrate_tour(*o, to); }); };
  });
}

void add_run(CLI::App& calibrate, Chosen& chosen) {
  using sim::calibration::Strategy;
  auto o = std::make_shared<CalibrateOptions>();
  o->course.threads = all_cores();
  o->course.rounds = 250;
  auto* run = calibrate.add_subcommand(
      "run", "Fit parameters to the poses; under mpirun, each process its part");
  run->footer("Exit codes: 0 done, 1 interrupted: --resume goes on; 2 bad usage or input.");
  add_poses(run, o->robot, o->poses);
  run->add_option("--vary", o->choice, "which parameters: <calibration><vary …/>…")->required();
  run->add_option("--out", o->course.folder, "folder for the calibrated robot.xml and the rest")
      ->required();
  run->add_option("--strategy", o->how.strategy, "evolution, cma (CMA-ES) or newton (Gauss-Newton)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Strategy>{{"evolution", Strategy::evolution},
                                          {"cma", Strategy::cma},
                                          {"newton", Strategy::newton}}));
  run->add_option("--generations", o->course.rounds, "of it, at most")
      ->capture_default_str()
      ->check(above_zero());
  run->add_option("--seed", o->how.seed, "of what is drawn")->capture_default_str();
  run->add_option("--bound", o->how.bound, "how many of its spread a parameter may go")
      ->capture_default_str()
      ->check(above_zero());
  run->add_option("--threads", o->course.threads, "default: all cores")->check(above_zero());
  run->add_flag("--resume", o->course.resume, "go on with what is in the folder");
  run->callback([=, &chosen] {
    chosen = [=] {
      const auto signals = std::make_shared<Signals>();
      o->course.interrupted = [signals] { return signals->take() != 0; };
      return calibrate_run(*o, std::cout, std::cerr);
    };
  });
}

void add_judge(CLI::App& calibrate, Chosen& chosen) {
  auto robot = std::make_shared<std::string>();
  auto poses = std::make_shared<PoseFiles>();
  auto* check = calibrate.add_subcommand("check", "How far a robot.xml is off in the poses");
  add_poses(check, *robot, *poses);
  check->callback(
      [=, &chosen] { chosen = [=] { return calibrate_check(*robot, *poses, std::cout); }; });
}

/// "elbow=32.9".
std::pair<std::string, double> joint_off(const std::string& text) {
  const auto equals = text.find('=');
  double degrees = 0;
  if (equals == std::string::npos || !CLI::detail::lexical_cast(text.substr(equals + 1), degrees) ||
      !(degrees > 0))
    throw std::invalid_argument("--off " + text + ": say JOINT=DEGREES, such as elbow=30");
  return {text.substr(0, equals), degrees};
}

void add_perturb(CLI::App& calibrate, Chosen& chosen) {
  auto o = std::make_shared<PerturbOptions>();
  auto* perturb = calibrate.add_subcommand(
      "perturb", "A robot.xml as far off the poses as asked, to try a calibration on");
  add_poses(perturb, o->robot, o->poses);
  perturb->add_option("--vary", o->choice, "which parameters: <calibration><vary …/>…")->required();
  auto off = std::make_shared<std::vector<std::string>>();
  perturb->add_option("--off", *off, "JOINT=DEGREES …: mean angle off")->required();
  perturb->add_option("--seed", o->seed, "of what is drawn")->capture_default_str();
  perturb->add_option("--out", o->out, "the new robot.xml")->required();
  perturb->callback([=, &chosen] {
    chosen = [=] {
      for (const std::string& one : *off) o->off_deg.insert(joint_off(one));
      return calibrate_perturb(*o, std::cout);
    };
  });
}

}  // namespace

void add_calibrate(CLI::App& app, Chosen& chosen) {
  auto* calibrate =
      app.add_subcommand("calibrate", "The model fitted to poses in which the robot stood still");
  calibrate->require_subcommand(1);
  add_tour(*calibrate, chosen);
  add_run(*calibrate, chosen);
  add_judge(*calibrate, chosen);
  add_perturb(*calibrate, chosen);
}

}  // namespace launch
