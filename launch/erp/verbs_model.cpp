#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "launch/erp/model.hpp"
#include "launch/text/text_files.hpp"
#include "launch/erp/verbs.hpp"

namespace launch {

namespace {

/// Prints, or writes a file: only once all is computed, because the robot may include that file.
int give(const std::string& file, const std::function<int(std::ostream&)>& print) {
  std::ostringstream text;
  const int code = print(text);
  if (file.empty()) return std::cout << text.str(), code;
  write_file(file, text.str());
  return code;
}

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

  auto part = std::make_shared<std::string>();
  auto* effects = model->add_subcommand(
      "effects", "What <effect> in robot.xml may say: types, places, parameters, bounds");
  effects->add_option("part", *part, "only types that contain this: gearbox, delay …");
  effects->callback([=, &chosen] { chosen = [=] { return model_effects(*part, std::cout); }; });
}

}  // namespace launch
