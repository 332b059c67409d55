#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "launch/erp/model/loops.hpp"
#include "launch/erp/model/model.hpp"
#include "launch/erp/model/muscles.hpp"
#include "launch/erp/verbs/verb_parts.hpp"
#include "launch/erp/verbs/verbs.hpp"

namespace launch {

namespace {

/// What follows from the balance of tensions and gravity.
void add_statics(CLI::App& model, Chosen& chosen) {
  auto robot = std::make_shared<std::string>(), table = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  auto least = std::make_shared<double>(5), rest = std::make_shared<double>(10);
  const auto add_options = [=](CLI::App* verb) {
    verb->add_option("--least", *least, "no tendon pulls less, N")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber);
    verb->add_option("--rest", *rest, "what each would like to pull, N")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber);
    verb->add_option("--out", *out, "a file to write; else it is printed");
  };
  auto* balance = model.add_subcommand(
      "balance", "The pretensions that hold the starting pose, as a part to include");
  balance->add_option("robot", *robot, "robot.xml")->required();
  add_options(balance);
  balance->callback([=, &chosen] {
    chosen = [=] {
      return give(*out, [=](auto& to) { return model_balance(*robot, *least, *rest, to); });
    };
  });

  auto* lengths = model.add_subcommand(
      "lengths", "Joint angles over time as line lengths: a trajectory for `target`");
  lengths->add_option("robot", *robot, "robot.xml")->required();
  lengths
      ->add_option("poses", *table,
                   "CSV with time_s and <joint>.angle_rad or <joint>.qw … .qz; or a recording")
      ->required();
  add_options(lengths);
  lengths->callback([=, &chosen] {
    chosen = [=] {
      return give(*out, [=](auto& to) { return model_lengths(*robot, *table, *least, *rest, to); });
    };
  });
}

void add_loops(CLI::App& model, Chosen& chosen) {
  auto options = std::make_shared<ModelLoopsOptions>();
  auto* verb = model.add_subcommand(
      "loops", "Robust loops around its hinges, designed from the model; prints their margin");
  verb->add_option("robot", options->robot, "robot.xml")->required();
  verb->add_option("loops", options->loops, "their shape: <loops crossover_Hz=\"2.5\" …/>");
  verb->add_option("--poses", options->poses, "CSV of postures in which they are tried");
  verb->add_option("--out", options->out, "a picture of the loops: .svg or .png");
  verb->callback([=, &chosen] { chosen = [=] { return model_loops(*options, std::cout); }; });
}

void add_babble(CLI::App& model, Chosen& chosen) {
  auto robot = std::make_shared<std::string>(), out = std::make_shared<std::string>();
  auto how = std::make_shared<sim::muscle_networks::BabbleOptions>();
  auto* babble = model.add_subcommand(
      "babble", "Tendon forces at random: a trajectory for `target`, to learn muscles from");
  babble->add_option("robot", *robot, "robot.xml")->required();
  babble->add_option("--seconds", how->duration_s, "how long")
      ->capture_default_str()
      ->check(above_zero());
  babble->add_option("--seed", how->seed, "of what is drawn")->capture_default_str();
  babble->add_option("--least", how->least_N, "no tendon pulls less, N")->capture_default_str();
  babble->add_option("--mean", how->mean_N, "what each pulls more, on average, N")
      ->capture_default_str()
      ->check(above_zero());
  babble->add_option("--out", *out, "a file to write; else it is printed");
  babble->callback([=, &chosen] {
    chosen = [=] { return give(*out, [=](auto& to) { return model_babble(*robot, *how, to); }); };
  });
}

void add_motion(CLI::App& model, Chosen& chosen) {
  auto robot = std::make_shared<std::string>(), out = std::make_shared<std::string>();
  auto led = std::make_shared<sim::muscle_networks::JointMotionOptions>();
  auto* motion = model.add_subcommand(
      "motion", "Poses all over the workspace, for `joint_target`, to learn muscles from");
  motion->add_option("robot", *robot, "robot.xml")->required();
  motion->add_option("--seconds", led->duration_s, "how long")
      ->capture_default_str()
      ->check(above_zero());
  motion->add_option("--share", led->share, "of their top speed that motors wind with")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1.0));
  motion->add_option("--ball", led->workspace.ball_rad, "ball joints turn by at most so much, rad")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 3.0));
  motion->add_option("--seed", led->workspace.seed, "of what is drawn")->capture_default_str();
  motion->add_option("--out", *out, "a file to write; else it is printed");
  motion->callback([=, &chosen] {
    chosen = [=] { return give(*out, [=](auto& to) { return model_motion(*robot, *led, to); }); };
  });
}

void add_muscles(CLI::App& model, Chosen& chosen) {
  auto options = std::make_shared<ModelMusclesOptions>();
  auto* muscles = model.add_subcommand(
      "muscles", "Learns from recordings how muscles' lengths change with the joints");
  muscles->add_option("robot", options->robot, "robot.xml")->required();
  muscles->add_option("recordings", options->recordings, "of the robot moving, its joints known")
      ->required();
  muscles->add_option("--units", options->units, "hidden units of each muscle's network")
      ->capture_default_str()
      ->check(CLI::Range(2, 200));
  muscles->add_option("--held-out", options->held_out, "share of each recording that only checks")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 0.9));
  muscles
      ->add_option("--ball", options->over.ball_rad,
                   "torques are compared with ball joints turned by at most so much, rad")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 3.0));
  muscles->add_option("--out", options->out, "the new file of networks, for computed_force");
  muscles->callback([=, &chosen] { chosen = [=] { return model_muscles(*options, std::cout); }; });
}

}  // namespace

void add_model(CLI::App& app, Chosen& chosen) {
  auto* model = app.add_subcommand("model", "A robot in figures, and in the formats of others");
  model->require_subcommand(1);
  auto robot = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);

  auto* info = model->add_subcommand("info", "Bodies, joints, muscles, mass …");
  info->add_option("robot", *robot, "robot.xml")->required();
  info->add_flag("--json", *json, "as one JSON object");
  info->callback([=, &chosen] { chosen = [=] { return model_info(*robot, *json, std::cout); }; });

  auto* export_verb = model->add_subcommand("export", "Write it for another simulator");
  export_verb->add_option("robot", *robot, "robot.xml")->required();
  export_verb
      ->add_option(
          "out", *out,
          "the new file: OUT.dae for COLLADA, the whole robot; OUT.mjcf.xml for MuJoCo, OUT.urdf, "
          "OUT.sdf; OUT.svg for a picture")
      ->required();
  export_verb->callback([=, &chosen] { chosen = [=] { return model_export(*robot, *out); }; });

  auto* import_verb = model->add_subcommand(
      "import", "The robot of a COLLADA file of ours, or the skeleton of another program's file");
  import_verb->add_option("in", *robot, "IN.dae, IN.urdf or IN.sdf")->required();
  import_verb->add_option("out", *out, "the new robot.xml")->required();
  import_verb->callback([=, &chosen] { chosen = [=] { return model_import(*robot, *out); }; });
  add_statics(*model, chosen);
  add_loops(*model, chosen);
  add_babble(*model, chosen);
  add_motion(*model, chosen);
  add_muscles(*model, chosen);

  auto part = std::make_shared<std::string>();
  auto* effects = model->add_subcommand(
      "effects", "What <effect> in robot.xml may say: types, places, parameters, bounds");
  effects->add_option("part", *part, "only types that contain this: gearbox, delay …");
  effects->callback([=, &chosen] { chosen = [=] { return model_effects(*part, std::cout); }; });
}

}  // namespace launch
