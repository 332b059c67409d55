#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "launch/erp/model/model.hpp"
#include "launch/erp/model/muscles.hpp"
#include "launch/erp/verbs/verb_parts.hpp"
#include "launch/erp/verbs/verbs.hpp"

namespace launch {

namespace {

/// Adds the verbs that compute the balance of tensions and gravity.
void add_statics(CLI::App& model, Chosen& chosen) {
  auto robot = std::make_shared<std::string>(), table = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  auto min_N = std::make_shared<double>(5), rest_N = std::make_shared<double>(10);
  const auto add_options = [=](CLI::App* verb) {
    verb->add_option("--least", *min_N, "smallest tension, N")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber);
    verb->add_option("--rest", *rest_N, "preferred tension, N")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber);
    verb->add_option("--out", *out, "output file (default: stdout)");
  };
  auto* balance = model.add_subcommand(
      "balance",
      "Print the pretensions that hold the starting pose, as a part to include in robot.xml");
  balance->add_option("robot", *robot, "robot.xml")->required();
  add_options(balance);
  balance->callback([=, &chosen] {
    chosen = [=] {
      return write_output(*out,
                          [=](auto& to) { return model_balance(*robot, *min_N, *rest_N, to); });
    };
  });

  auto* lengths = model.add_subcommand(
      "lengths", "Print the line lengths for joint angles over time, as a trajectory for `target`");
  lengths->add_option("robot", *robot, "robot.xml")->required();
  lengths
      ->add_option("poses", *table,
                   "CSV with time_s and <joint>.angle_rad or <joint>.qw … .qz, or a recording")
      ->required();
  add_options(lengths);
  lengths->callback([=, &chosen] {
    chosen = [=] {
      return write_output(
          *out, [=](auto& to) { return model_lengths(*robot, *table, *min_N, *rest_N, to); });
    };
  });
}

void add_loops(CLI::App& model, Chosen& chosen) {
  auto options = std::make_shared<ModelLoopsOptions>();
  auto* verb = model.add_subcommand(
      "loops",
      "Design H-infinity loops of the hinges from the model and print their stability margin");
  verb->add_option("robot", options->robot, "robot.xml")->required();
  verb->add_option("loops", options->loops,
                   "file with the loop shape: <loops crossover_Hz=\"2.5\" …/>");
  verb->add_option("--poses", options->poses, "CSV of postures to check");
  verb->add_option("--out", options->out, "picture of the loops, .svg or .png");
  verb->callback([=, &chosen] { chosen = [=] { return model_loops(*options, std::cout); }; });
}

void add_babble(CLI::App& model, Chosen& chosen) {
  auto robot = std::make_shared<std::string>(), out = std::make_shared<std::string>();
  auto options = std::make_shared<sim::muscle_networks::BabbleOptions>();
  auto* babble = model.add_subcommand(
      "babble", "Print random tendon forces, as a trajectory for `target`, for training data");
  babble->add_option("robot", *robot, "robot.xml")->required();
  babble->add_option("--seconds", options->duration_s, "duration, s")
      ->capture_default_str()
      ->check(above_zero());
  babble->add_option("--seed", options->seed, "random seed")->capture_default_str();
  babble->add_option("--least", options->least_N, "smallest tension, N")->capture_default_str();
  babble->add_option("--mean", options->mean_N, "mean tension above the smallest, N")
      ->capture_default_str()
      ->check(above_zero());
  babble->add_option("--out", *out, "output file (default: stdout)");
  babble->callback([=, &chosen] {
    chosen = [=] {
      return write_output(*out, [=](auto& to) { return model_babble(*robot, *options, to); });
    };
  });
}

void add_motion(CLI::App& model, Chosen& chosen) {
  auto robot = std::make_shared<std::string>(), out = std::make_shared<std::string>();
  auto options = std::make_shared<sim::muscle_networks::JointMotionOptions>();
  auto* motion = model.add_subcommand(
      "motion", "Print poses that cover the workspace, for `joint_target`, for training data");
  motion->add_option("robot", *robot, "robot.xml")->required();
  motion->add_option("--seconds", options->duration_s, "duration, s")
      ->capture_default_str()
      ->check(above_zero());
  motion->add_option("--share", options->share, "motor speed as a fraction of the maximum")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1.0));
  motion->add_option("--ball", options->workspace.ball_rad, "largest rotation of ball joints, rad")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 3.0));
  motion->add_option("--seed", options->workspace.seed, "random seed")->capture_default_str();
  motion->add_option("--out", *out, "output file (default: stdout)");
  motion->callback([=, &chosen] {
    chosen = [=] {
      return write_output(*out, [=](auto& to) { return model_motion(*robot, *options, to); });
    };
  });
}

void add_muscles(CLI::App& model, Chosen& chosen) {
  auto options = std::make_shared<ModelMusclesOptions>();
  auto* muscles = model.add_subcommand(
      "muscles", "Train networks for muscle lengths over joint angles from recordings");
  muscles->add_option("robot", options->robot, "robot.xml")->required();
  muscles
      ->add_option("recordings", options->recordings,
                   "recordings of the moving robot with measured joints")
      ->required();
  muscles->add_option("--units", options->units, "hidden units of each muscle's network")
      ->capture_default_str()
      ->check(CLI::Range(2, 200));
  muscles
      ->add_option("--held-out", options->held_out,
                   "fraction of each recording used for validation only")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 0.9));
  muscles
      ->add_option("--ball", options->comparison.ball_rad,
                   "largest rotation of ball joints in the comparison of torques, rad")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 3.0));
  muscles->add_option("--out", options->out, "new file of networks, for computed_force");
  muscles->callback([=, &chosen] { chosen = [=] { return model_muscles(*options, std::cout); }; });
}

}  // namespace

void add_model(CLI::App& app, Chosen& chosen) {
  auto* model =
      app.add_subcommand("model", "Print properties of a robot, convert it to other formats");
  model->require_subcommand(1);
  auto robot = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);

  auto* info = model->add_subcommand("info", "Print bodies, joints, muscles, mass …");
  info->add_option("robot", *robot, "robot.xml")->required();
  info->add_flag("--json", *json, "print one JSON object");
  info->callback([=, &chosen] { chosen = [=] { return model_info(*robot, *json, std::cout); }; });

  auto* export_verb =
      model->add_subcommand("export", "Write the robot in the format of another simulator");
  export_verb->add_option("robot", *robot, "robot.xml")->required();
  export_verb
      ->add_option(
          "out", *out,
          "new file: OUT.dae for COLLADA, the whole robot; OUT.mjcf.xml for MuJoCo, OUT.urdf, "
          "OUT.sdf; OUT.svg for a picture")
      ->required();
  export_verb->callback([=, &chosen] { chosen = [=] { return model_export(*robot, *out); }; });

  auto* import_verb = model->add_subcommand(
      "import",
      "Read the robot of a COLLADA file written by erp, or the skeleton of a URDF or SDF file");
  import_verb->add_option("in", *robot, "IN.dae, IN.urdf or IN.sdf")->required();
  import_verb->add_option("out", *out, "new robot.xml")->required();
  import_verb->callback([=, &chosen] { chosen = [=] { return model_import(*robot, *out); }; });
  add_statics(*model, chosen);
  add_loops(*model, chosen);
  add_babble(*model, chosen);
  add_motion(*model, chosen);
  add_muscles(*model, chosen);

  auto part = std::make_shared<std::string>();
  auto* effects = model->add_subcommand(
      "effects",
      "List the types of <effect> in robot.xml with what they act on, parameters and bounds");
  effects->add_option("part", *part, "only types that contain this text: gearbox, delay …");
  effects->callback([=, &chosen] { chosen = [=] { return model_effects(*part, std::cout); }; });
}

}  // namespace launch
