#include "launch/erp/record/joints.hpp"
#include "launch/erp/record/log.hpp"

#include <filesystem>
#include <iostream>
#include <memory>

#include "launch/erp/verbs/verbs.hpp"

namespace launch {
namespace {

using Text = std::shared_ptr<std::string>;

Text add_file(CLI::App& verb, const char* help) {
  auto file = std::make_shared<std::string>();
  verb.add_option("file", *file, help)->required();
  return file;
}

void add_info(CLI::App& log, Chosen& chosen) {
  auto* verb =
      log.add_subcommand("info", "Print duration, topics, message counts and missing messages");
  const Text file = add_file(*verb, "recording, .mcap");
  verb->callback([=, &chosen] { chosen = [=] { return log_info(*file, std::cout); }; });
}

void add_export(CLI::App& log, Chosen& chosen) {
  auto* verb = log.add_subcommand("export", "Print the recording as CSV");
  const Text file = add_file(*verb, "recording, .mcap");
  auto options = std::make_shared<LogExportOptions>();
  verb->add_option("--topic", options->topic,
                   "print the messages of this topic instead of one row per cycle");
  verb->add_option("--robot", options->robot, "robot, if the recording has several");
  verb->callback([=, &chosen] { chosen = [=] { return log_export(*file, std::cout, *options); }; });
}

void add_recover(CLI::App& log, Chosen& chosen) {
  auto* verb = log.add_subcommand(
      "recover", "Copy the readable messages of an incomplete recording to a new file");
  const Text file = add_file(*verb, "incomplete recording");
  auto out = std::make_shared<std::string>();
  verb->add_option("--out", *out, "new file (default: FILE with .recovered.mcap)");
  verb->callback([=, &chosen] {
    chosen = [=] {
      const std::string target =
          out->empty() ? std::filesystem::path(*file).replace_extension(".recovered.mcap").string()
                       : *out;
      return log_recover(*file, target, std::cout);
    };
  });
}

void add_plot(CLI::App& log, Chosen& chosen) {
  auto* verb = log.add_subcommand("plot", "Draw a recording; needs gnuplot");
  const Text file = add_file(*verb, "recording, .mcap or .csv");
  auto out = std::make_shared<std::string>();
  auto options = std::make_shared<LogPlotOptions>();
  verb->add_option("--out", *out, "picture, .svg or .png (default: FILE.svg)");
  verb->add_option("--signal", options->signals,
                   "flexor, tension_N or flexor.tension_N; repeatable (default: tensions, line "
                   "lengths and joint angles)")
      ->allow_extra_args(false);
  verb->add_option("--robot", options->robot, "robot, if the recording has several");
  verb->add_option("--title", options->title, "title of the picture (default: file name)");
  verb->callback([=, &chosen] {
    chosen = [=] {
      const std::string picture = out->empty() ? *file + ".svg" : *out;
      const int exit_code = log_plot(*file, picture, *options);
      if (exit_code == 0) std::cout << picture << '\n';
      return exit_code;
    };
  });
}

void add_joints(CLI::App& log, Chosen& chosen) {
  auto* verb =
      log.add_subcommand("joints", "Print the difference between two sources of joint angles");
  const Text file = add_file(*verb, "recording, .mcap");
  auto options = std::make_shared<LogJointsOptions>();
  verb->add_option("--of", options->source,
                   "compared source: sim, pose_estimator or motion_capture")
      ->capture_default_str();
  verb->add_option("--against", options->reference_source,
                   "reference source: joint_target or one of the above")
      ->capture_default_str();
  verb->add_option("--from", options->from_s, "ignore the time before, s")->capture_default_str();
  verb->add_option("--out", options->out, "also draw a picture, .svg or .png; needs gnuplot");
  verb->callback([=, &chosen] { chosen = [=] { return log_joints(*file, *options, std::cout); }; });
}

void add_effort(CLI::App& log, Chosen& chosen) {
  auto* verb = log.add_subcommand("effort", "Print tensions and energy of each muscle");
  const Text file = add_file(*verb, "recording, .mcap or .csv");
  auto from_s = std::make_shared<double>(0);
  verb->add_option("--from", *from_s, "ignore the time before, s")->capture_default_str();
  verb->callback([=, &chosen] { chosen = [=] { return log_effort(*file, *from_s, std::cout); }; });
}

}  // namespace

void add_log(CLI::App& app, Chosen& chosen) {
  auto* log = app.add_subcommand("log", "Inspect, export, recover and plot recordings");
  log->require_subcommand(1);
  add_info(*log, chosen);
  add_export(*log, chosen);
  add_recover(*log, chosen);
  add_plot(*log, chosen);
  add_joints(*log, chosen);
  add_effort(*log, chosen);
}

}  // namespace launch
