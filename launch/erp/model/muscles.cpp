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

/// Samples to learn from, and the ends of the recordings to check with.
struct Split {
  LengthSamples learn, check;
};

void append(LengthSamples& to, const LengthSamples& from, std::size_t begin, std::size_t end) {
  to.joints.insert(to.joints.end(), from.joints.begin() + std::ptrdiff_t(begin),
                   from.joints.begin() + std::ptrdiff_t(end));
  const auto old = to.length_m.cols(), more = std::ptrdiff_t(end - begin);
  to.length_m.conservativeResize(from.length_m.rows(), old + more);
  to.length_m.rightCols(more) = from.length_m.middleCols(std::ptrdiff_t(begin), more);
}

Split read(const erp::Robot& robot, const ModelMusclesOptions& options) {
  Split split;
  for (const std::string& file : options.recordings) try {
      const auto samples = muscle_networks::samples_of(robot, recording::read_table(file));
      const auto all = samples.joints.size();
      const auto learn = all - std::size_t(options.held_out * double(all));
      append(split.learn, samples, 0, learn);
      append(split.check, samples, learn, all);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(file + ": " + error.what());
    }
  return split;
}

/// The same samples one after the other, with nothing known before.
muscle_networks::LengthLearner learnt_on_line(const erp::Robot& robot, const LengthSamples& samples) {
  const sim::Musculoskeletal model(robot);
  constexpr int units = 400;  // chosen: here nothing is known before, and nobody waits
  muscle_networks::LengthLearner learner({model.tree().joints, model.skeleton()}, samples.length_m.rows(),
                                  {.units = units, .noise_m = 1e-4});
  for (std::size_t k = 0; k < samples.joints.size(); ++k)
    learner.hear(samples.joints[k], samples.length_m.col(std::ptrdiff_t(k)));
  return learner;
}

/// RMS, by muscle, of what the networks leave where they have not learnt.
Eigen::VectorXd held_out_m(const erp::Robot& robot, const muscle_networks::LearntMuscles& learnt,
                           const LengthSamples& check) {
  muscle_networks::LearntLengths lengths(robot, learnt);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(check.length_m.rows());
  for (std::size_t k = 0; k < check.joints.size(); ++k)
    squares +=
        (lengths.length_m(check.joints[k]) - check.length_m.col(std::ptrdiff_t(k))).cwiseAbs2();
  return (squares / double(check.joints.size())).cwiseSqrt();
}

void print_lengths(const erp::Robot& robot, const muscle_networks::LearntMuscles& learnt,
                   const Split& split, std::ostream& out) {
  const auto off_m = held_out_m(robot, learnt, split.check);
  const auto held_out = [&](std::size_t a) {
    return split.check.joints.empty() ? "-" : fmt::format("{:.3f}", 1e3 * off_m[std::ptrdiff_t(a)]);
  };
  out << fmt::format("{} samples learnt, {} held out: lengths off, mm\n{:<24} {:>10} {:>10}\n",
                     split.learn.joints.size(), split.check.joints.size(), "muscle", "learnt",
                     "held out");
  for (std::size_t a = 0; a < learnt.list.size(); ++a)
    out << fmt::format("{:<24} {:>10.3f} {:>10}\n", learnt.list[a].name,
                       1e3 * learnt.list[a].left_m, held_out(a));
}

void print_torques(const erp::Robot& robot, const muscle_networks::LearntMuscles& learnt,
                   const LengthSamples& samples, const ModelMusclesOptions& options,
                   std::ostream& out) {
  constexpr std::size_t count = 5000;  // chosen: with 1000 the figure itself is 10 % uncertain
  const auto drawn = muscle_networks::postures(robot, count, options.over);
  const auto off = [&](const muscle_networks::JacobianAt& jacobian) {
    return 100 * muscle_networks::torque_error(robot, drawn, jacobian).share;
  };
  muscle_networks::LearntLengths lengths(robot, learnt);
  auto learner = learnt_on_line(robot, samples);
  out << fmt::format("torques off those of {} over {} postures that its muscles can hold, %\n",
                     options.robot, count);
  const auto row = [&](const char* by, double percent) {
    out << fmt::format("{:<24} {:>10.2f}\n", by, percent);
  };
  row("networks, derivative", off([&](auto q) -> auto& { return lengths.jacobian(q); }));
  row("networks, difference",
      off([&](auto q) -> auto& { return lengths.jacobian_by_difference(q); }));
  row("learnt on line", off([&](auto q) -> auto& { return learner.jacobian(q); }));
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
  muscle_networks::LearnOptions how;
  how.units = options.units;
  how.progress = [](std::size_t done, std::size_t of) {
    fmt::print(stderr, "\r{} of {} muscles learnt{}", done, of, done == of ? "\n" : "");
  };
  const auto learnt = muscle_networks::learn(robot, split.learn, how);
  if (!options.out.empty()) write_file(options.out, xml::write(learnt));
  print_lengths(robot, learnt, split, out);
  print_torques(robot, learnt, split.learn, options, out);
  return 0;
}

}  // namespace launch
