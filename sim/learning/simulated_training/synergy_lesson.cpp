#include "sim/learning/simulated_training/synergy_lesson.hpp"

#include <stdexcept>

#include "sim/control/holding.hpp"
#include "sim/learning/training_loop/dice.hpp"
#include "sim/world/simulated_robot.hpp"

namespace sim::simulated_training {

using namespace synergy;
using Eigen::VectorXd;

bool play(Trial& trial, const erp::Robot& robot, const HandConfig& hand_config,
          const std::vector<std::size_t>& muscles, std::uint64_t seed) try {
  constexpr double tick_s = 0.002;
  SimulatedRobot simulated(robot, seed);
  const Hand hand(hand_config, simulated.world().body_names());
  std::vector<SetPoint> asked(robot.actuators.size(), {erp::Mode::length, 0});
  for (int k = 0; !trial.done(); ++k) {
    trial.see(tick_s * k, hand.in(simulated.world().poses()));
    const VectorXd& line_m = trial.step(tick_s * k);
    for (std::size_t m = 0; m < muscles.size(); ++m)
      asked[muscles[m]].reference = line_m[static_cast<Eigen::Index>(m)];
    simulated.tick(asked);
    for (const auto& said : erp::samples(simulated.frame().channels))
      if (static_cast<erp::EcuState>(said.state) == erp::EcuState::fault) return false;
  }
  return true;
} catch (const NotFinite&) {
  return false;
}

SynergyLesson::SynergyLesson(const erp::Robot& robot, const Task& task,
                             const std::vector<Pose>& poses)
    : robot_(robot), task_(task), muscles_(actuators_of(task.muscles.all, robot)) {
  file_.seed = std::to_string(task.seed), file_.options = task.options, file_.times = task.times;
  file_.hand = task.hand, file_.bottle = task.bottle, file_.muscles.all = task.muscles.all;
  const World start(robot);
  file_.rest_m = numbers(Hand(task.hand, start.body_names()).in(start.poses()));
  add_rough_plans(poses);
  if (bank_.plans().empty())
    throw std::invalid_argument(task.place.file + ": no plan to begin with");
}

/// Where a rough plan leads it leads when it is played; one that the hand does not come back from is
/// left out.
void SynergyLesson::add_rough_plans(const std::vector<Pose>& poses) {
  PoseHolder holder(robot_);
  bank_ = Bank(task_.options, {});
  for (const Pose& pose : poses) {
    const auto line_m = holder.hold(pose, {.rest_N = 20, .least_N = 8}).line_m;
    MotorPlan plan{.weights_m = VectorXd(std::ssize(muscles_)), .at_m = Vec3::Zero()};
    for (std::size_t m = 0; m < muscles_.size(); ++m)
      plan.weights_m[static_cast<Eigen::Index>(m)] = -line_m[muscles_[m]];
    Trial trial(plan, task_.times, 0, 0);
    const bool came_back = played(trial, Vec3::Zero(), seed()).came_back;
    plan.at_m = rest_of(trial.path());
    if (came_back) bank_.add(std::move(plan));
  }
}

Taught SynergyLesson::played(Trial& trial, const Vec3& target_m, std::uint64_t seed) const {
  if (!play(trial, robot_, task_.hand, muscles_, seed)) return {};
  return taught_by(trial, task_.bottle, vec(file_.rest_m), target_m);
}

struct SynergyLesson::Try {
  Vec3 target_m;
  Blend blend;
  MotorPlan plan;
  std::mt19937_64 dice;
};

SynergyLesson::Try SynergyLesson::planned(std::size_t place) const {
  auto dice = training_loop::dice(seed(), static_cast<std::uint64_t>(rounds()), place);
  const Vec3 target_m = task_.zone.draw(dice);
  Blend blend = bank_.blend(target_m);
  MotorPlan plan = blend.plan;
  if (place % 2 == 1) plan = varied(std::move(plan), task_.exploring, dice);
  return {target_m, std::move(blend), std::move(plan), std::move(dice)};
}

/// Whether it struck, what is to be credited; then, if the hand came back, the plan's value and where
/// it led.
std::vector<double> SynergyLesson::tried(Try one) const {
  Trial trial(one.plan, task_.times, task_.noise, one.dice());
  const Taught taught = played(trial, one.target_m, one.dice());
  std::vector<double> numbers{taught.outcome.struck ? 1.0 : 0.0, taught.credit};
  if (!taught.plan) return numbers;
  const Vec3& at_m = taught.plan->at_m;
  numbers.insert(numbers.end(), {taught.plan->value, at_m.x(), at_m.y(), at_m.z()});
  return numbers;
}

void SynergyLesson::round(const Pool& pool) {
  const auto count = static_cast<std::size_t>(task_.batch);
  std::vector<Try> tries;
  for (std::size_t k = 0; k < count; ++k) tries.push_back(planned(k));
  const auto all = pool.map(count, [&](std::size_t k) { return tried(tries[k]); });
  struck_ = came_back_ = reward_ = 0;
  std::vector<MotorPlan> fresh;
  for (std::size_t k = 0; k < count; ++k) {
    Try& one = tries[k];
    const bool came_back = all[k].size() > 2;
    bank_.credit(one.blend.credits, all[k][1]);
    if (k % 2 == 0) struck_ += all[k][0], reward_ += all[k][1], came_back_ += came_back;
    if (!came_back) continue;
    one.plan.value = all[k][2], one.plan.at_m = {all[k][3], all[k][4], all[k][5]};
    if (task_.zone.holds(one.plan.at_m, task_.beyond_m)) fresh.push_back(std::move(one.plan));
  }
  for (MotorPlan& plan : fresh) bank_.add(std::move(plan));
  bank_.trim();
  const int plain = (task_.batch + 1) / 2;
  struck_ /= plain, came_back_ /= plain, reward_ /= plain;
  ++file_.rounds;
}

std::vector<training_loop::Metric> SynergyLesson::metrics() const {
  return {{"struck_percent", 100 * struck_},
          {"came_back_percent", 100 * came_back_},
          {"mean_reward", reward_}};
}

SynergyLesson::Test SynergyLesson::test(const Bank& bank, std::uint64_t seed,
                                        std::size_t number) const {
  auto dice = training_loop::dice(seed, ~std::uint64_t(0), number);
  Test test{.target_m = task_.zone.draw(dice)};
  Trial trial(bank.blend(test.target_m).plan, task_.times, task_.noise, dice());
  const Taught taught = played(trial, test.target_m, dice());
  test.came_back = taught.came_back, test.outcome = taught.outcome;
  test.relative_jerk = relative_jerk(trial.path(), trial.end_s());
  return test;
}

std::string SynergyLesson::state() const { return text_of(file_, bank_); }

void SynergyLesson::restore(const std::string& text, const std::string& name) {
  auto kept = xml::parse<BankFile>(text, name);
  check(kept);
  if (kept.seed != file_.seed || kept.muscles.all.size() != file_.muscles.all.size())
    throw std::invalid_argument(name + ": of another seed or other muscles; resume with those");
  bank_ = bank_of(kept);
  kept.plans.all.clear();
  file_ = std::move(kept);
}

}  // namespace sim::simulated_training
