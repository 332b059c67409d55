#include "sim/lessons/synergy_lesson.hpp"

#include <stdexcept>

#include "sim/actuator/holding.hpp"
#include "sim/learner/dice.hpp"
#include "sim/rehearsal/puppet.hpp"

namespace sim::lessons {

using namespace synergy;
using Eigen::VectorXd;

namespace {

constexpr TrialTimes at_once{.way_s = 0, .still_s = 0.1};

TrialTimes from_rest(const TrialTimes& times) {
  return {at_once.way_s, at_once.still_s, times.watch_s};
}

}  // namespace

bool play(Trial& trial, const erp::Robot& robot, const HandConfig& hand_config,
          const std::vector<std::size_t>& muscles, std::uint64_t seed) {
  constexpr double tick_s = 0.002;
  rehearsal::Puppet puppet(robot, seed);
  const Hand hand(hand_config, puppet.world().body_names());
  std::vector<rehearsal::Asked> asked(robot.actuators.size(), {erp::Mode::length, 0});
  const VectorXd start_m = VectorXd::Zero(std::ssize(muscles));
  for (int k = 0; !trial.done(); ++k) {
    trial.see(tick_s * k, hand.in(puppet.world().poses()));
    const VectorXd& line_m = trial.step(tick_s * k, start_m);
    for (std::size_t m = 0; m < muscles.size(); ++m)
      asked[muscles[m]].reference = line_m[static_cast<Eigen::Index>(m)];
    puppet.tick(asked);
    for (const auto& said : erp::samples(puppet.frame().channels))
      if (static_cast<erp::EcuState>(said.state) == erp::EcuState::fault) return false;
  }
  return true;
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

/// Where a rough plan leads it leads when it is played; one that trips an ECU is left out.
void SynergyLesson::add_rough_plans(const std::vector<Pose>& poses) {
  PoseHolder holder(robot_);
  bank_ = Bank(task_.options, {});
  for (const Pose& pose : poses) {
    const auto line_m = holder.hold(pose, {.rest_N = 20, .least_N = 8}).line_m;
    MotorPlan plan{.weights_m = VectorXd(std::ssize(muscles_)), .at_m = Vec3::Zero()};
    for (std::size_t m = 0; m < muscles_.size(); ++m)
      plan.weights_m[static_cast<Eigen::Index>(m)] = -line_m[muscles_[m]];
    Trial trial(plan, from_rest(task_.times), 0, 0);
    if (!play(trial, robot_, task_.hand, muscles_, seed())) continue;
    plan.at_m = rest_of(trial.path());
    bank_.add(std::move(plan));
  }
}

struct SynergyLesson::Try {
  Vec3 target_m;
  Blend blend;
  MotorPlan plan;
  std::mt19937_64 dice;
};

SynergyLesson::Try SynergyLesson::planned(std::size_t place) const {
  auto dice = learner::dice(seed(), static_cast<std::uint64_t>(rounds()), place);
  const Vec3 target_m = task_.zone.draw(dice);
  Blend blend = bank_.blend(target_m);
  MotorPlan plan = blend.plan;
  if (place % 2 == 1) plan = varied(std::move(plan), task_.exploring, dice);
  return {target_m, std::move(blend), std::move(plan), std::move(dice)};
}

/// Whether it struck, its reward, its value where it led, that place; nothing: an ECU tripped.
std::vector<double> SynergyLesson::tried(Try one) const {
  Trial trial(one.plan, from_rest(task_.times), task_.noise, one.dice());
  if (!play(trial, robot_, task_.hand, muscles_, one.dice())) return {};
  const Outcome outcome = judge(task_.bottle, one.target_m, trial.path(), trial.end_s());
  const MotorPlan led = as_it_led(trial, task_.bottle, one.target_m);
  return {outcome.struck ? 1.0 : 0.0,
          outcome.reward,
          led.value,
          led.at_m.x(),
          led.at_m.y(),
          led.at_m.z()};
}

void SynergyLesson::round(const Pool& pool) {
  const auto count = static_cast<std::size_t>(task_.batch);
  std::vector<Try> tries;
  for (std::size_t k = 0; k < count; ++k) tries.push_back(planned(k));
  const auto all = pool.map(count, [&](std::size_t k) { return tried(tries[k]); });
  double struck = 0, reward = 0;
  int plain = 0;
  std::vector<MotorPlan> fresh;
  for (std::size_t k = 0; k < count; ++k) {
    if (k % 2 == 0) ++plain;
    if (all[k].empty()) {
      ++tripped_;
      continue;
    }
    Try& one = tries[k];
    bank_.credit(one.blend.credits, all[k][1]);
    if (k % 2 == 0) struck += all[k][0], reward += all[k][1];
    one.plan.value = all[k][2], one.plan.at_m = {all[k][3], all[k][4], all[k][5]};
    if (task_.zone.holds(one.plan.at_m, task_.beyond_m)) fresh.push_back(std::move(one.plan));
  }
  for (MotorPlan& plan : fresh) bank_.add(std::move(plan));
  bank_.trim();
  struck_ = struck / plain, reward_ = reward / plain;
  ++file_.rounds;
}

std::vector<learner::Metric> SynergyLesson::metrics() const {
  return {{"struck_percent", 100 * struck_}, {"mean_reward", reward_}};
}

SynergyLesson::Test SynergyLesson::test(const Bank& bank, std::uint64_t seed,
                                        std::size_t number) const {
  auto dice = learner::dice(seed, ~std::uint64_t(0), number);
  Test test{.target_m = task_.zone.draw(dice)};
  Trial trial(bank.blend(test.target_m).plan, from_rest(task_.times), task_.noise, dice());
  test.tripped = !play(trial, robot_, task_.hand, muscles_, dice());
  if (test.tripped) return test;
  test.outcome = judge(task_.bottle, test.target_m, trial.path(), trial.end_s());
  test.relative_jerk = relative_jerk(trial.path(), trial.end_s());
  return test;
}

std::string SynergyLesson::state() const {
  BankFile file = file_;
  file.plans.all = rows_of(bank_);
  return xml::write(file);
}

void SynergyLesson::restore(const std::string& text, const std::string& name) {
  auto kept = xml::parse<BankFile>(text, name);
  check(kept);
  if (kept.seed != file_.seed || kept.muscles.all.size() != file_.muscles.all.size())
    throw std::invalid_argument(name + ": of another seed or other muscles; resume with those");
  bank_ = bank_of(kept);
  kept.plans.all.clear();
  file_ = std::move(kept);
}

}  // namespace sim::lessons
