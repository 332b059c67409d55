#include "sim/learning/simulated_training/synergy_training.hpp"

#include <stdexcept>

#include "sim/control/holding.hpp"
#include "sim/learning/training_loop/random_stream.hpp"
#include "sim/world/simulated_robot.hpp"

namespace sim::simulated_training {

using namespace synergy;
using Eigen::VectorXd;

bool play(Trial& trial, const erp::Robot& robot, const HandConfig& hand_config,
          const std::vector<std::size_t>& muscles, std::uint64_t seed) try {
  constexpr double tick_s = 0.002;  // period of the ECUs
  SimulatedRobot simulated(robot, seed);
  const Hand hand(hand_config, simulated.world().body_names());
  std::vector<SetPoint> set_points(robot.actuators.size(), {erp::Mode::length, 0});
  for (int k = 0; !trial.done(); ++k) {
    trial.see(tick_s * k, hand.in(simulated.world().poses()));
    const VectorXd& line_m = trial.step(tick_s * k);
    for (std::size_t m = 0; m < muscles.size(); ++m)
      set_points[muscles[m]].reference = line_m[static_cast<Eigen::Index>(m)];
    simulated.tick(set_points);
    for (const auto& sample : erp::samples(simulated.frame().channels))
      if (static_cast<erp::EcuState>(sample.state) == erp::EcuState::fault) return false;
  }
  return true;
} catch (const NotFinite&) {
  return false;
}

SynergyTraining::SynergyTraining(const erp::Robot& robot, const Task& task,
                                 const std::vector<Pose>& poses)
    : robot_(robot), task_(task), muscles_(actuators_of(task.muscles.all, robot)) {
  file_.seed = std::to_string(task.seed), file_.options = task.options, file_.times = task.times;
  file_.hand = task.hand, file_.bottle = task.bottle, file_.muscles.all = task.muscles.all;
  const World start(robot);
  file_.rest_m = numbers(Hand(task.hand, start.body_names()).in(start.poses()));
  add_rough_plans(poses);
  if (bank_.plans().empty())
    throw std::invalid_argument(
        task.place.file + ": the hand returns from none of the rough plans; change its poses");
}

/// Runs each rough plan to find the place that it reaches. Plans from which the hand does not
/// return are not stored.
void SynergyTraining::add_rough_plans(const std::vector<Pose>& poses) {
  PoseHolder holder(robot_);
  bank_ = Bank(task_.options, {});
  for (const Pose& pose : poses) {
    const auto line_m = holder.hold(pose, {.rest_N = 20, .least_N = 8}).line_m;
    MotorPlan plan{.weights_m = VectorXd(std::ssize(muscles_)), .at_m = Vec3::Zero()};
    for (std::size_t m = 0; m < muscles_.size(); ++m)
      plan.weights_m[static_cast<Eigen::Index>(m)] = -line_m[muscles_[m]];
    Trial trial(plan, task_.times, 0, 0);
    const bool returned = play_trial(trial, Vec3::Zero(), seed()).returned;
    plan.at_m = rest_of(trial.path());
    if (returned) bank_.add(std::move(plan));
  }
}

TrialResult SynergyTraining::play_trial(Trial& trial, const Vec3& target_m,
                                        std::uint64_t seed) const {
  if (!play(trial, robot_, task_.hand, muscles_, seed)) return {};
  return result_of(trial, task_.bottle, vec(file_.rest_m), target_m);
}

struct SynergyTraining::PlannedTrial {
  Vec3 target_m;
  Blend blend;
  MotorPlan plan;
  std::mt19937_64 random;
};

SynergyTraining::PlannedTrial SynergyTraining::plan_trial(std::size_t index) const {
  auto random = training_loop::random_stream(seed(), static_cast<std::uint64_t>(rounds()), index);
  const Vec3 target_m = task_.zone.draw(random);
  Blend blend = bank_.blend(target_m);
  MotorPlan plan = blend.plan;
  if (index % 2 == 1) plan = varied(std::move(plan), task_.exploring, random);
  return {target_m, std::move(blend), std::move(plan), std::move(random)};
}

/// Returns whether the trial struck and the credit; if the hand returned, also the plan's value and
/// its place.
std::vector<double> SynergyTraining::run_trial(PlannedTrial planned) const {
  Trial trial(planned.plan, task_.times, task_.noise, planned.random());
  const TrialResult result = play_trial(trial, planned.target_m, planned.random());
  std::vector<double> numbers{result.outcome.struck ? 1.0 : 0.0, result.credit};
  if (!result.plan) return numbers;
  const Vec3& at_m = result.plan->at_m;
  numbers.insert(numbers.end(), {result.plan->value, at_m.x(), at_m.y(), at_m.z()});
  return numbers;
}

void SynergyTraining::round(const Pool& pool) {
  const auto count = static_cast<std::size_t>(task_.batch);
  std::vector<PlannedTrial> trials;
  for (std::size_t k = 0; k < count; ++k) trials.push_back(plan_trial(k));
  const auto results = pool.map(count, [&](std::size_t k) { return run_trial(trials[k]); });
  struck_ = returned_ = reward_ = 0;
  std::vector<MotorPlan> new_plans;
  for (std::size_t k = 0; k < count; ++k) {
    PlannedTrial& trial = trials[k];
    const bool returned = results[k].size() > 2;
    bank_.credit(trial.blend.credits, results[k][1]);
    if (k % 2 == 0) struck_ += results[k][0], reward_ += results[k][1], returned_ += returned;
    if (!returned) continue;
    trial.plan.value = results[k][2],
    trial.plan.at_m = {results[k][3], results[k][4], results[k][5]};
    if (task_.zone.contains(trial.plan.at_m, task_.margin_m))
      new_plans.push_back(std::move(trial.plan));
  }
  for (MotorPlan& plan : new_plans) bank_.add(std::move(plan));
  bank_.trim();
  const int unvaried_count = (task_.batch + 1) / 2;
  struck_ /= unvaried_count, returned_ /= unvaried_count, reward_ /= unvaried_count;
  ++file_.rounds;
}

std::vector<training_loop::Metric> SynergyTraining::metrics() const {
  return {{"struck_percent", 100 * struck_},
          {"returned_percent", 100 * returned_},
          {"mean_reward", reward_}};
}

SynergyTraining::Test SynergyTraining::test(const Bank& bank, std::uint64_t seed,
                                            std::size_t number) const {
  auto random = training_loop::random_stream(seed, ~std::uint64_t(0), number);
  Test test{.target_m = task_.zone.draw(random)};
  Trial trial(bank.blend(test.target_m).plan, task_.times, task_.noise, random());
  const TrialResult result = play_trial(trial, test.target_m, random());
  test.returned = result.returned, test.outcome = result.outcome;
  test.relative_jerk = relative_jerk(trial.path(), trial.end_s());
  return test;
}

std::string SynergyTraining::state() const { return text_of(file_, bank_); }

void SynergyTraining::restore(const std::string& text, const std::string& name) {
  auto saved = xml::parse<BankFile>(text, name);
  check(saved);
  if (saved.seed != file_.seed || saved.muscles.all.size() != file_.muscles.all.size())
    throw std::invalid_argument(
        name + ": was written with another seed or other muscles; resume with the same");
  bank_ = bank_of(saved);
  saved.plans.all.clear();
  file_ = std::move(saved);
}

}  // namespace sim::simulated_training
