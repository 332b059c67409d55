#include "launch/erp/verbs/verbs.hpp"

#include <charconv>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>

#include "interfaces/emergency.hpp"
#include "interfaces/xml/values.hpp"
#include "launch/erp/command/command.hpp"
#include "launch/erp/text/duration.hpp"

namespace launch {
namespace {

CLI::Validator below_emergency() {
  return CLI::Range(std::numeric_limits<int>::min(), erp::emergency_priority - 1).description("");
}

void add_robot_option(CLI::App& verb, std::string& robot, const char* default_text) {
  verb.add_option("--robot", robot,
                  std::string("name of the robot (default: ") + default_text + ")");
}

void add_stop(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand(
      "stop", "Switch all actuators off at the highest priority; they stay off until released");
  auto options = std::make_shared<StopOptions>();
  add_robot_option(*verb, options->robot, "every robot on the bus");
  verb->add_flag("--release", options->release, "let controllers command the robot again");
  verb->callback(
      [options, &chosen] { chosen = [options] { return stop_robots(*options, std::cout); }; });
}

double parse_number(const std::string& text, const std::string& what) {
  double value = 0;
  if (const auto error = xml::Codec<double>::read(text, value, {}))
    throw std::invalid_argument(what + " must be a number, got \"" + text + "\"");
  return value;
}

void add_send(CLI::App& app, Chosen& chosen) {
  auto* verb =
      app.add_subcommand("send", "Command actuators of a running robot: erp send flexor force 10");
  auto options = std::make_shared<SendOptions>();
  auto words = std::make_shared<std::vector<std::string>>();
  auto duration = std::make_shared<std::string>();
  verb->add_option("words", *words,
                   "actuators, then voltage, length, current or force with a value in V, m (change "
                   "since the start, negative winds up), A or N; or off")
      ->required()
      ->expected(2, 64);
  add_robot_option(*verb, options->robot, "the only one on the bus");
  verb->add_option("--priority", options->priority, "the controller of highest priority drives")
      ->check(below_emergency())
      ->capture_default_str();
  verb->add_option("--for", *duration, "duration: 20s, 500ms, 2min … (default: until Ctrl-C)");
  verb->callback([options, words, duration, &chosen] {
    chosen = [options, words, duration] {
      const bool is_off = words->back() == "off";
      if (!is_off) {
        if (words->size() < 3)
          throw std::invalid_argument("send: give actuators, a mode and a value");
        options->reference = parse_number(words->back(), "the value");
        words->pop_back();
      }
      options->mode = words->back();
      if (!is_off && options->mode == "off") throw std::invalid_argument("send: off has no value");
      words->pop_back();
      options->actuators = *words;
      if (!duration->empty()) options->for_s = parse_duration_s(*duration);
      return send_command(*options, std::cout);
    };
  });
}

void add_set(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand(
      "set",
      "Change gains of an actuator's ECU: erp set flexor "
      "length_gain_V_per_rad=3; limits may only be lowered; until the plant restarts");
  auto options = std::make_shared<SetOptions>();
  auto words = std::make_shared<std::vector<std::string>>();
  verb->add_option("actuator", options->actuator, "actuator")->required();
  verb->add_option("gains", *words, "NAME=VALUE, with names of firmware/core/parameters.h")
      ->required();
  add_robot_option(*verb, options->robot, "the only one on the bus");
  verb->add_option("--priority", options->priority, "must exceed that of the actuator's owner")
      ->check(below_emergency())
      ->capture_default_str();
  verb->callback([options, words, &chosen] {
    chosen = [options, words] {
      for (const std::string& word : *words) {
        const auto equals = word.find('=');
        if (equals == word.npos)
          throw std::invalid_argument("set: \"" + word + "\" is not NAME=VALUE");
        const std::string name = word.substr(0, equals);
        options->gains.emplace_back(name, parse_number(word.substr(equals + 1), name));
      }
      return set_gains(*options, std::cout);
    };
  });
}

void add_home(CLI::App& app, Chosen& chosen) {
  auto* verb = app.add_subcommand(
      "home",
      "Set the zeros of encoders after a reset of their ECUs: winds the lines gently until "
      "the robot rests, and computes their lengths from robot.xml and the sensors");
  auto options = std::make_shared<HomeOptions>();
  verb->add_option("actuators", options->actuators,
                   "actuators (default: those whose zero is unknown)");
  verb->add_flag("--all", options->all, "every actuator");
  verb->add_flag("--here", options->here,
                 "the robot is in its starting pose now: sets the zeros without moving it");
  verb->add_option("--tension", options->tension_N, "largest tension of a line while homing, N")
      ->check(CLI::Range(5.0, 15.0))
      ->capture_default_str();
  verb->add_option("--xml", options->xml, "robot.xml (default: that of the running plant)");
  add_robot_option(*verb, options->robot, "the only one on the bus");
  verb->add_option("--priority", options->priority, "must exceed that of the actuators' owner")
      ->check(below_emergency())
      ->capture_default_str();
  verb->callback(
      [options, &chosen] { chosen = [options] { return home_robot(*options, std::cout); }; });
}

}  // namespace

void add_command(CLI::App& app, Chosen& chosen) {
  add_send(app, chosen);
  add_set(app, chosen);
  add_home(app, chosen);
  add_stop(app, chosen);
}

}  // namespace launch
