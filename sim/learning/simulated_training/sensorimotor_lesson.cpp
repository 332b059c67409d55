#include "sim/learning/simulated_training/sensorimotor_lesson.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "sim/model/actuator/noise.hpp"
#include "sim/learning/training_loop/dice.hpp"
#include "sim/world/simulated_robot.hpp"
#include "sim/learning/sensorimotor/learnt_file.hpp"

namespace sim::simulated_training {

using namespace sensorimotor;
using Eigen::VectorXd;

void play(Session& session, const erp::Robot& robot, const Eye& eye, double noise_px,
          std::uint64_t seed) {
  constexpr double tick_s = 0.002;
  constexpr int image_ticks = 5;
  SimulatedRobot simulated(robot, seed);
  Noise noise(seed);
  std::vector<SetPoint> asked(robot.actuators.size());
  for (int k = 0;; ++k) {
    const double time_s = tick_s * k;
    if (k % image_ticks == 0)
      if (auto senses = eye.see(simulated.world().poses())) {
        for (double& sense : *senses) sense += noise_px / eye.focal_px() * noise.normal();
        session.see(time_s, *senses);
      }
    const VectorXd& motors_N = session.motors_N(time_s);
    if (session.done()) return;
    for (std::size_t a = 0; a < asked.size(); ++a)
      asked[a] = {erp::Mode::force,
                  robot.actuators[a].tendon.pretension_N + motors_N[static_cast<Eigen::Index>(a)]};
    simulated.tick(asked);
  }
}

std::vector<GoalAt> reachable_goals(const erp::Robot& robot, const Eye& eye, const GoalDraw& draw,
                                    const Pool& pool) {
  constexpr int ticks = 1000, most_draws = 100;
  const auto seen = [&](std::size_t goal, std::uint64_t again) -> std::optional<VectorXd> {
    auto dice = training_loop::dice(draw.seed, goal, again);
    std::uniform_int_distribution<std::size_t> any(0, robot.actuators.size() - 1);
    std::uniform_real_distribution<double> force_N(0, draw.most_N);
    std::vector<SetPoint> asked;
    for (const erp::Actuator& a : robot.actuators)
      asked.push_back({erp::Mode::force, a.tendon.pretension_N});
    for (int k = 0; k < draw.muscles; ++k) asked[any(dice)].reference += force_N(dice);
    SimulatedRobot simulated(robot, dice());
    for (int k = 0; k < ticks; ++k) simulated.tick(asked);
    return eye.see(simulated.world().poses());
  };
  const auto all = pool.map(static_cast<std::size_t>(draw.count), [&](std::size_t goal) {
    for (std::uint64_t again = 0; again < most_draws; ++again)
      if (const auto at = seen(goal, again)) return Pool::Numbers(at->begin(), at->end());
    throw std::runtime_error(
        "in a hundred draws the marker was never in every image; turn the "
        "cameras to where it goes");
  });
  std::vector<GoalAt> goals;
  for (const auto& at : all) goals.push_back({{}, at});
  return goals;
}

SensorimotorLesson::SensorimotorLesson(const erp::Robot& robot, const cameras::ViewConfig& view,
                                       const Experiment& experiment)
    : robot_(robot),
      eye_(view, RobotTree(robot)),
      experiment_(experiment),
      learnt_(eye_.senses(), std::ssize(robot.actuators)),
      goals_(goals_of(experiment, eye_.senses())) {
  experiment_.session.seed = seed();
}

void SensorimotorLesson::twitch() {
  SessionOptions options = experiment_.session;
  options.tries = 0;
  Session session(options, learnt_, {});
  play(session, robot_, eye_, experiment_.noise_px, seed());
  learnt_ = session.learnt();
}

/// One try more: its α, its error, whether it asked for more than the most.
std::vector<double> SensorimotorLesson::tried(std::size_t goal) const {
  SessionOptions options = experiment_.session;
  options.twitches = 0, options.tries = 1;
  Session session(options, learnt_, {goals_[goal]});
  play(session, robot_, eye_, experiment_.noise_px,
       training_loop::dice(seed(), static_cast<std::uint64_t>(rounds_), goal)());
  const Goal& after = session.goals().front();
  std::vector<double> numbers(after.alpha.begin(), after.alpha.end());
  numbers.push_back(after.errors.back());
  numbers.push_back(session.limited());
  return numbers;
}

void SensorimotorLesson::round(const Pool& pool) {
  if (rounds_ == 0) twitch();
  else {
    const auto all = pool.map(goals_.size(), [&](std::size_t k) { return tried(k); });
    for (std::size_t k = 0; k < all.size(); ++k) {
      goals_[k].alpha = Eigen::Map<const VectorXd>(all[k].data(), eye_.senses());
      goals_[k].errors.push_back(all[k][static_cast<std::size_t>(eye_.senses())]);
      limited_ += static_cast<int>(all[k].back());
    }
  }
  ++rounds_;
}

std::vector<training_loop::Metric> SensorimotorLesson::metrics() const {
  double sum = 0, squares = 0;
  std::size_t count = 0;
  for (const Goal& goal : goals_)
    if (!goal.errors.empty())
      sum += goal.errors.back(), squares += std::pow(goal.errors.back(), 2), ++count;
  const double n = std::max<double>(1, double(count)), mean = sum / n;
  return {{"mean_error", mean},
          {"deviation_of_error", std::sqrt(std::max(0.0, squares / n - mean * mean))}};
}

std::string SensorimotorLesson::state() const {
  LearntFile file = file_of(learnt_, goals_);
  file.rounds = rounds_, file.seed = std::to_string(experiment_.seed);
  return xml::write(file);
}

void SensorimotorLesson::restore(const std::string& text, const std::string& file) {
  const auto kept = xml::parse<LearntFile>(text, file);
  auto goals = goals_of(kept, eye_.senses());
  if (kept.seed != std::to_string(experiment_.seed) || goals.size() != goals_.size())
    throw std::invalid_argument(file + ": of another seed or other goals; resume with those");
  learnt_ = learnt_of(kept, eye_.senses(), std::ssize(robot_.actuators));
  goals_ = std::move(goals);
  rounds_ = kept.rounds;
}

}  // namespace sim::simulated_training
