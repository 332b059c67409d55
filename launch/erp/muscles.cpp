#include "launch/erp/muscles.hpp"

#include <fmt/format.h>

#include <ostream>

#include "interfaces/recording/csv.hpp"
#include "interfaces/xml/xml.hpp"
#include "launch/text/text_files.hpp"
#include "sim/learning/length_learner.hpp"
#include "sim/learning/length_samples.hpp"
#include "sim/learning/torque_error.hpp"

namespace launch {
namespace {

namespace learning = sim::learning;
using learning::LengthSamples;

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
      const auto samples = learning::samples_of(robot, recording::read_table(file));
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
learning::LengthLearner learnt_on_line(const erp::Robot& robot, const LengthSamples& samples) {
  const sim::Musculoskeletal model(robot);
  learning::LengthLearner learner({model.tree().joints, model.skeleton()}, samples.length_m.rows(),
                                  {});
  for (std::size_t k = 0; k < samples.joints.size(); ++k)
    learner.hear(samples.joints[k], samples.length_m.col(std::ptrdiff_t(k)));
  return learner;
}

}  // namespace

int model_babble(const std::string& robot_file, const learning::BabbleOptions& options,
                 std::ostream& out) {
  recording::write_csv(learning::babble(erp::read_robot(robot_file), options), out);
  return 0;
}

int model_muscles(const ModelMusclesOptions& options, std::ostream& out) {
  const erp::Robot robot = erp::read_robot(options.robot);
  const Split split = read(robot, options);
  learning::LearnOptions how;
  how.units = options.units;
  how.progress = [](std::size_t done, std::size_t of) {
    fmt::print(stderr, "\r{} of {} muscles learnt{}", done, of, done == of ? "\n" : "");
  };
  const auto learnt = learning::learn(robot, split.learn, how);
  if (!options.out.empty()) write_file(options.out, xml::write(learnt));
  if (split.check.joints.empty()) return 0;
  learning::LearntLengths lengths(robot, learnt);
  const std::span postures(split.check.joints);
  const auto by_slope = learning::torque_error(
      robot, postures, [&](auto q) -> auto& { return lengths.jacobian(q); });
  const auto by_difference = learning::torque_error(
      robot, postures, [&](auto q) -> auto& { return lengths.jacobian_by_difference(q); });
  auto learner = learnt_on_line(robot, split.learn);
  const auto on_line = learning::torque_error(
      robot, postures, [&](auto q) -> auto& { return learner.jacobian(q); });
  out << fmt::format("{} samples learnt, {} held out\n{:<24} {:>14} {:>20}\n",
                     split.learn.joints.size(), split.check.joints.size(), "muscle",
                     "length off, mm", "moment arm off, mm");
  for (std::size_t a = 0; a < learnt.list.size(); ++a)
    out << fmt::format("{:<24} {:>14.3f} {:>20.3f}\n", learnt.list[a].name,
                       1e3 * learnt.list[a].left_m, 1e3 * by_slope.moment_arm_m[a]);
  out << fmt::format(
      "torques off those of {}: {:.2f} % by the networks' derivative, {:.2f} % by difference "
      "quotient, {:.2f} % learnt on line\n",
      options.robot, 100 * by_slope.share, 100 * by_difference.share, 100 * on_line.share);
  return 0;
}

}  // namespace launch
