#include "sim/learning/simulated_training/sensorimotor_training.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "sim/learning/sensorimotor/learned_map_file.hpp"
#include "sim/learning/training_loop/random_stream.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/world/simulated_robot.hpp"

namespace sim::simulated_training {

using namespace sensorimotor;
using Eigen::VectorXd;

void play(Session& session, const erp::Robot& robot, const Eye& eye, double noise_px,
          std::uint64_t seed) {
  constexpr double tick_s = 0.002;  // period of the ECUs
  constexpr int image_ticks = 5;    // 100 Hz
  SimulatedRobot simulated(robot, seed);
  Noise noise(seed);
  std::vector<SetPoint> set_points(robot.actuators.size());
  for (int k = 0;; ++k) {
    const double time_s = tick_s * k;
    if (k % image_ticks == 0)
      if (auto senses = eye.see(simulated.world().poses())) {
        for (double& sense : *senses) sense += noise_px / eye.focal_px() * noise.normal();
        session.see(time_s, *senses);
      }
    const VectorXd& motors_N = session.motors_N(time_s);
    if (session.done()) return;
    for (std::size_t a = 0; a < set_points.size(); ++a)
      set_points[a] = {erp::Mode::force, robot.actuators[a].tendon.pretension_N +
                                             motors_N[static_cast<Eigen::Index>(a)]};
    simulated.tick(set_points);
  }
}

std::vector<GoalAt> reachable_goals(const erp::Robot& robot, const Eye& eye, const GoalDraw& draw,
                                    const Pool& pool) {
  constexpr int ticks = 1000, max_draws = 100;  // 2 s; chosen
  const auto marker_senses = [&](std::size_t goal,
                                 std::uint64_t attempt) -> std::optional<VectorXd> {
    auto random = training_loop::random_stream(draw.seed, goal, attempt);
    std::uniform_int_distribution<std::size_t> any_muscle(0, robot.actuators.size() - 1);
    std::uniform_real_distribution<double> force_N(0, draw.most_N);
    std::vector<SetPoint> set_points;
    for (const erp::Actuator& a : robot.actuators)
      set_points.push_back({erp::Mode::force, a.tendon.pretension_N});
    for (int k = 0; k < draw.muscles; ++k)
      set_points[any_muscle(random)].reference += force_N(random);
    SimulatedRobot simulated(robot, random());
    for (int k = 0; k < ticks; ++k) simulated.tick(set_points);
    return eye.see(simulated.world().poses());
  };
  const auto results = pool.map(static_cast<std::size_t>(draw.count), [&](std::size_t goal) {
    for (std::uint64_t attempt = 0; attempt < max_draws; ++attempt)
      if (const auto at = marker_senses(goal, attempt))
        return Pool::Numbers(at->begin(), at->end());
    throw std::runtime_error(
        "in a hundred draws the marker was never in every image; turn the "
        "cameras to where it goes");
  });
  std::vector<GoalAt> goals;
  for (const auto& at : results) goals.push_back({{}, at});
  return goals;
}

SensorimotorTraining::SensorimotorTraining(const erp::Robot& robot, const cameras::ViewConfig& view,
                                           const Experiment& experiment)
    : robot_(robot),
      eye_(view, RobotTree(robot)),
      experiment_(experiment),
      learned_(eye_.senses(), std::ssize(robot.actuators)),
      goals_(goals_of(experiment, eye_.senses())) {
  experiment_.session.seed = seed();
}

void SensorimotorTraining::twitch() {
  SessionOptions options = experiment_.session;
  options.trials = 0;
  Session session(options, learned_, {});
  play(session, robot_, eye_, experiment_.noise_px, seed());
  learned_ = session.learned();
}

/// One more trial of a goal: its α, its error, whether it exceeded the force limit.
std::vector<double> SensorimotorTraining::run_trial(std::size_t goal) const {
  SessionOptions options = experiment_.session;
  options.twitches = 0, options.trials = 1;
  Session session(options, learned_, {goals_[goal]});
  play(session, robot_, eye_, experiment_.noise_px,
       training_loop::random_stream(seed(), static_cast<std::uint64_t>(rounds_), goal)());
  const Goal& after = session.goals().front();
  std::vector<double> numbers(after.alpha.begin(), after.alpha.end());
  numbers.push_back(after.errors.back());
  numbers.push_back(session.limited());
  return numbers;
}

void SensorimotorTraining::round(const Pool& pool) {
  if (rounds_ == 0) twitch();
  else {
    const auto results = pool.map(goals_.size(), [&](std::size_t k) { return run_trial(k); });
    for (std::size_t k = 0; k < results.size(); ++k) {
      goals_[k].alpha = Eigen::Map<const VectorXd>(results[k].data(), eye_.senses());
      goals_[k].errors.push_back(results[k][static_cast<std::size_t>(eye_.senses())]);
      limited_ += static_cast<int>(results[k].back());
    }
  }
  ++rounds_;
}

std::vector<training_loop::Metric> SensorimotorTraining::metrics() const {
  double sum = 0, squares = 0;
  std::size_t count = 0;
  for (const Goal& goal : goals_)
    if (!goal.errors.empty())
      sum += goal.errors.back(), squares += std::pow(goal.errors.back(), 2), ++count;
  const double n = std::max<double>(1, double(count)), mean = sum / n;
  return {{"mean_error", mean},
          {"deviation_of_error", std::sqrt(std::max(0.0, squares / n - mean * mean))}};
}

std::string SensorimotorTraining::state() const {
  LearnedMapFile file = file_of(learned_, goals_);
  file.rounds = rounds_, file.seed = std::to_string(experiment_.seed);
  return xml::write(file);
}

void SensorimotorTraining::restore(const std::string& text, const std::string& file) {
  const auto saved = xml::parse<LearnedMapFile>(text, file);
  auto goals = goals_of(saved, eye_.senses());
  if (saved.seed != std::to_string(experiment_.seed) || goals.size() != goals_.size())
    throw std::invalid_argument(
        file + ": was written with another seed or other goals; resume with the same");
  learned_ = learned_map_of(saved, eye_.senses(), std::ssize(robot_.actuators));
  goals_ = std::move(goals);
  rounds_ = saved.rounds;
}

}  // namespace sim::simulated_training
