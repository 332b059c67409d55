#include "launch/erp/model/muscles.hpp"

#include <fmt/format.h>

#include <ostream>

#include "interfaces/recording/csv.hpp"
#include "interfaces/xml/xml.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/learning/muscle_networks/length_learner.hpp"
#include "sim/learning/muscle_networks/length_samples.hpp"
#include "sim/learning/muscle_networks/torque_error.hpp"

namespace launch {
namespace {

namespace muscle_networks = sim::muscle_networks;
using muscle_networks::LengthSamples;

/// Training samples, and validation samples, which come from the end of each recording.
struct Split {
  LengthSamples train, validate;
};

void append(LengthSamples& to, const LengthSamples& from, std::size_t begin, std::size_t end) {
  to.joints.insert(to.joints.end(), from.joints.begin() + std::ptrdiff_t(begin),
                   from.joints.begin() + std::ptrdiff_t(end));
  const auto old_count = to.length_m.cols(), new_count = std::ptrdiff_t(end - begin);
  to.length_m.conservativeResize(from.length_m.rows(), old_count + new_count);
  to.length_m.rightCols(new_count) = from.length_m.middleCols(std::ptrdiff_t(begin), new_count);
}

Split read(const erp::Robot& robot, const ModelMusclesOptions& options) {
  Split split;
  for (const std::string& file : options.recordings) try {
      const auto samples = muscle_networks::samples_of(robot, recording::read_table(file));
      const auto sample_count = samples.joints.size();
      const auto train_count = sample_count - std::size_t(options.held_out * double(sample_count));
      append(split.train, samples, 0, train_count);
      append(split.validate, samples, train_count, sample_count);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(file + ": " + error.what());
    }
  return split;
}

/// Trains a network online with the same samples in sequence, without prior knowledge.
muscle_networks::LengthLearner trained_online(const erp::Robot& robot,
                                              const LengthSamples& samples) {
  const sim::Musculoskeletal model(robot);
  constexpr int units = 400;        // chosen: there is no limit on computing time
  constexpr double noise_m = 1e-4;  // of the measured lengths; chosen
  muscle_networks::LengthLearner learner({model.tree().joints, model.skeleton()},
                                         samples.length_m.rows(),
                                         {.units = units, .noise_m = noise_m});
  for (std::size_t k = 0; k < samples.joints.size(); ++k)
    learner.add_sample(samples.joints[k], samples.length_m.col(std::ptrdiff_t(k)));
  return learner;
}

/// RMS length error of each muscle on the validation samples.
Eigen::VectorXd validation_error_m(const erp::Robot& robot,
                                   const muscle_networks::LearnedMuscles& trained,
                                   const LengthSamples& samples) {
  muscle_networks::LearnedLengths lengths(robot, trained);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(samples.length_m.rows());
  for (std::size_t k = 0; k < samples.joints.size(); ++k)
    squares +=
        (lengths.length_m(samples.joints[k]) - samples.length_m.col(std::ptrdiff_t(k))).cwiseAbs2();
  return (squares / double(samples.joints.size())).cwiseSqrt();
}

void print_lengths(const erp::Robot& robot, const muscle_networks::LearnedMuscles& trained,
                   const Split& split, std::ostream& out) {
  const auto error_m = validation_error_m(robot, trained, split.validate);
  const auto held_out = [&](std::size_t a) {
    return split.validate.joints.empty() ? "-"
                                         : fmt::format("{:.3f}", 1e3 * error_m[std::ptrdiff_t(a)]);
  };
  out << fmt::format(
      "{} training samples, {} held out: RMS length error, mm\n{:<24} {:>10} {:>10}\n",
      split.train.joints.size(), split.validate.joints.size(), "muscle", "training", "held out");
  for (std::size_t a = 0; a < trained.list.size(); ++a)
    out << fmt::format("{:<24} {:>10.3f} {:>10}\n", trained.list[a].name,
                       1e3 * trained.list[a].left_m, held_out(a));
}

void print_torques(const erp::Robot& robot, const muscle_networks::LearnedMuscles& trained,
                   const LengthSamples& samples, const ModelMusclesOptions& options,
                   std::ostream& out) {
  constexpr std::size_t count = 5000;  // chosen: with 1000 the result has an uncertainty of 10 %
  const auto postures = muscle_networks::postures(robot, count, options.comparison);
  const auto error_percent = [&](const muscle_networks::JacobianAt& jacobian) {
    return 100 * muscle_networks::torque_error(robot, postures, jacobian).share;
  };
  muscle_networks::LearnedLengths lengths(robot, trained);
  auto learner = trained_online(robot, samples);
  out << fmt::format("torque error relative to {} over {} postures that its muscles can hold, %\n",
                     options.robot, count);
  const auto row = [&](const char* method, double percent) {
    out << fmt::format("{:<24} {:>10.2f}\n", method, percent);
  };
  row("networks, derivative", error_percent([&](auto q) -> auto& { return lengths.jacobian(q); }));
  row("networks, difference",
      error_percent([&](auto q) -> auto& { return lengths.jacobian_by_difference(q); }));
  row("trained online", error_percent([&](auto q) -> auto& { return learner.jacobian(q); }));
}

}  // namespace

int model_babble(const std::string& robot_file, const muscle_networks::BabbleOptions& options,
                 std::ostream& out) {
  recording::write_csv(muscle_networks::babble(erp::read_robot(robot_file), options), out);
  return 0;
}

int model_motion(const std::string& robot_file, const muscle_networks::JointMotionOptions& options,
                 std::ostream& out) {
  recording::write_csv(muscle_networks::joint_motion(erp::read_robot(robot_file), options), out);
  return 0;
}

int model_muscles(const ModelMusclesOptions& options, std::ostream& out) {
  const erp::Robot robot = erp::read_robot(options.robot);
  const Split split = read(robot, options);
  muscle_networks::LearnOptions learn_options;
  learn_options.units = options.units;
  learn_options.progress = [](std::size_t trained_count, std::size_t total) {
    fmt::print(stderr, "\r{} of {} muscles trained{}", trained_count, total,
               trained_count == total ? "\n" : "");
  };
  const auto trained = muscle_networks::learn(robot, split.train, learn_options);
  if (!options.out.empty()) write_file(options.out, xml::write(trained));
  print_lengths(robot, trained, split, out);
  print_torques(robot, trained, split.train, options, out);
  return 0;
}

}  // namespace launch
