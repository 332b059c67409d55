#include <iostream>
#include <map>
#include <memory>

#include "launch/erp/learn/calibrate.hpp"
#include "launch/erp/run/signals.hpp"
#include "launch/erp/verbs/former_names.hpp"
#include "launch/erp/verbs/verb_parts.hpp"
#include "launch/erp/verbs/verbs.hpp"

namespace launch {
namespace {

void add_poses(CLI::App* verb, std::string& robot, PoseFiles& poses) {
  verb->add_option("--robot", robot, "robot.xml, the model")->required();
  verb->add_option("--real", poses.learn, "recordings of the robot with poses at rest")->required();
  verb->add_option("--check", poses.check,
                   "recordings with check poses; default: every second pose of --real");
}

void add_tour(CLI::App& calibrate, Chosen& chosen) {
  auto options = std::make_shared<TourOptions>();
  auto out = std::make_shared<std::string>();
  auto* tour = calibrate.add_subcommand(
      "tour",
      "Print the motion to record: each pose of a trajectory, held, and midway to the next");
  tour->add_option("lengths", options->lengths,
                   "trajectory of line lengths, as written by erp model lengths")
      ->required();
  tour->add_option("--hold", options->hold_s, "time that each pose is held, s")
      ->capture_default_str()
      ->check(CLI::Range(0.5, 600.0));
  tour->add_option("--move", options->move_s, "time from one pose to the next, s")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 600.0));
  add_former_option(*tour, "--still", "--hold");
  add_former_option(*tour, "--way", "--move");
  tour->add_option("--out", *out, "file to write; default: standard output");
  tour->callback([=, &chosen] {
    chosen = [=] {
      return write_output(*out, [=](std::ostream& to) { return calibrate_tour(*options, to); });
    };
  });
}

void add_run(CLI::App& calibrate, Chosen& chosen) {
  using sim::calibration::Strategy;
  auto options = std::make_shared<CalibrateOptions>();
  options->training.threads = all_cores();
  options->training.rounds = 250;
  auto* run = calibrate.add_subcommand(
      "run", "Fit parameters to the poses; under mpirun the processes share the work");
  run->footer("Exit codes: 0 done, 1 interrupted (continue with --resume), 2 bad usage or input.");
  add_poses(run, options->robot, options->poses);
  run->add_option("--vary", options->choice,
                  "file of the parameters to fit: <calibration><vary …/>…")
      ->required();
  run->add_option("--out", options->training.folder,
                  "folder for the calibrated robot.xml and the reports")
      ->required();
  run->add_option("--strategy", options->fit.strategy,
                  "evolution, cma (CMA-ES) or newton (Gauss-Newton)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Strategy>{{"evolution", Strategy::evolution},
                                          {"cma", Strategy::cma},
                                          {"newton", Strategy::newton}}));
  run->add_option("--generations", options->training.rounds, "largest number of rounds")
      ->capture_default_str()
      ->check(above_zero());
  run->add_option("--seed", options->fit.seed, "seed of the random numbers")->capture_default_str();
  run->add_option("--bound", options->fit.bound, "limit of a parameter's change, in spreads")
      ->capture_default_str()
      ->check(above_zero());
  run->add_option("--threads", options->training.threads, "default: all cores")
      ->check(above_zero());
  run->add_flag("--resume", options->training.resume, "continue the run in the folder");
  run->callback([=, &chosen] {
    chosen = [=] {
      const auto signals = std::make_shared<Signals>();
      options->training.interrupted = [signals] { return signals->take() != 0; };
      return calibrate_run(*options, std::cout, std::cerr);
    };
  });
}

void add_pose_check(CLI::App& calibrate, Chosen& chosen) {
  auto robot = std::make_shared<std::string>();
  auto poses = std::make_shared<PoseFiles>();
  auto* check = calibrate.add_subcommand("check", "Print the pose errors of a robot.xml");
  add_poses(check, *robot, *poses);
  check->callback(
      [=, &chosen] { chosen = [=] { return calibrate_check(*robot, *poses, std::cout); }; });
}

/// Parses "elbow=32.9": joint and mean error in degrees.
std::pair<std::string, double> parse_joint_error(const std::string& text) {
  const auto equals = text.find('=');
  double degrees = 0;
  if (equals == std::string::npos || !CLI::detail::lexical_cast(text.substr(equals + 1), degrees) ||
      !(degrees > 0))
    throw std::invalid_argument("--off " + text + ": write JOINT=DEGREES, for example elbow=30");
  return {text.substr(0, equals), degrees};
}

void add_perturb(CLI::App& calibrate, Chosen& chosen) {
  auto options = std::make_shared<PerturbOptions>();
  auto* perturb = calibrate.add_subcommand(
      "perturb", "Write a robot.xml with chosen pose errors, to test a calibration");
  add_poses(perturb, options->robot, options->poses);
  perturb
      ->add_option("--vary", options->choice,
                   "file of the parameters to fit: <calibration><vary …/>…")
      ->required();
  auto joint_errors = std::make_shared<std::vector<std::string>>();
  perturb->add_option("--off", *joint_errors, "JOINT=DEGREES …: mean error")->required();
  perturb->add_option("--seed", options->seed, "seed of the random numbers")->capture_default_str();
  perturb->add_option("--out", options->out, "the new robot.xml")->required();
  perturb->callback([=, &chosen] {
    chosen = [=] {
      for (const std::string& text : *joint_errors)
        options->pose_errors_deg.insert(parse_joint_error(text));
      return calibrate_perturb(*options, std::cout);
    };
  });
}

}  // namespace

void add_calibrate(CLI::App& app, Chosen& chosen) {
  auto* calibrate = app.add_subcommand("calibrate", "Fit the model to poses of the robot at rest");
  calibrate->require_subcommand(1);
  add_tour(*calibrate, chosen);
  add_run(*calibrate, chosen);
  add_pose_check(*calibrate, chosen);
  add_perturb(*calibrate, chosen);
}

}  // namespace launch
