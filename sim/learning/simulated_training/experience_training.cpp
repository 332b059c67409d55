#include "sim/learning/simulated_training/experience_training.hpp"

#include <stdexcept>

#include "sim/control/holding.hpp"
#include "sim/learning/experience/drives.hpp"
#include "sim/learning/experience/motors.hpp"
#include "sim/learning/training_loop/random_stream.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/world/simulated_robot.hpp"

namespace sim::simulated_training {

using namespace experience;
using Eigen::Vector3d;
using Eigen::VectorXd;

bool play(Reach& reach, const erp::Robot& robot, const HandConfig& hand_config, double noise_m,
          std::uint64_t seed, HandTrack* track) {
  constexpr double tick_s = 0.002;  // period of the ECUs
  SimulatedRobot simulated(robot, seed);
  const Motors motors(robot);
  const Hand hand(hand_config, simulated.world().body_names());
  Noise noise(seed);
  std::vector<SetPoint> set_points(robot.actuators.size());
  VectorXd line_m = VectorXd::Zero(std::ssize(set_points));
  std::vector<double> tension_N;
  for (const erp::Actuator& a : robot.actuators) tension_N.push_back(a.tendon.pretension_N);
  for (int k = 0; !reach.done(); ++k) {
    const Vector3d hand_m = hand.in(simulated.world().poses());
    const Vector3d measured_m =
        hand_m + noise_m * Vector3d(noise.normal(), noise.normal(), noise.normal());
    const MuscleCommand command = reach.step(tick_s * k, line_m, measured_m);
    for (std::size_t m = 0; m < set_points.size(); ++m) {
      const auto [mode, reference] = motors.ecu_reference(m, command, tension_N[m]);
      set_points[m] = {mode, reference};
    }
    simulated.tick(set_points);
    for (std::size_t m = 0; m < set_points.size(); ++m) {
      const auto& sample = simulated.sample_of(m);
      if (static_cast<erp::EcuState>(sample.state) == erp::EcuState::fault) return false;
      const EcuUnits& units = simulated.units(m);
      line_m[static_cast<Eigen::Index>(m)] = units.line_m(units.shaft_rad(sample.encoder_counts));
      tension_N[m] = units.tension_N(sample.tension_counts);
    }
    if (track) track->time_s.push_back(tick_s * k), track->hand_m.push_back(hand_m);
  }
  return true;
}

ExperienceTraining::ExperienceTraining(const erp::Robot& robot, const Task& task,
                                       const std::vector<Pose>& starts)
    : robot_(robot), task_(task) {
  file_.seed = std::to_string(task.seed);
  file_.pattern_V = task.pattern_V, file_.times = task.times;
  file_.hand = task.hand, file_.bursts.all = task.bursts.all;
  file_.drives.all = drives_of(robot);
  PoseHolder holder(robot);
  const HoldingOptions holding{.rest_N = task.rest_N, .least_N = task.least_N};
  for (const Pose& start : starts)
    file_.starts.all.push_back({{}, holder.hold(start, holding).line_m});
  check(file_, std::ssize(robot.actuators));
  base_ = base_of(file_);
}

Vec3 ExperienceTraining::fresh_target(std::uint64_t seed, std::size_t number) const {
  auto random = training_loop::random_stream(seed, ~std::uint64_t(0), number);
  return task_.zone.draw(random);
}

Reach ExperienceTraining::reach(int start, const Vec3& target_m,
                                std::shared_ptr<const Feedback> feedback) const {
  return reach_with(file_, start, target_m, within_voltage(file_, base_.inverse(start, target_m)),
                    std::move(feedback));
}

/// Runs a trial. Returns its scales, the place reached and its offset from the target; empty: an
/// ECU tripped.
std::vector<double> ExperienceTraining::run_trial(std::size_t index) const {
  auto random = training_loop::random_stream(seed(), static_cast<std::uint64_t>(rounds()), index);
  const int start = static_cast<int>(index / 2 % file_.starts.all.size());
  const Vec3 target = fresh_target(random(), 0);
  VectorXd scales_Vs = base_.inverse(start, target);
  if (explores(index)) {
    std::normal_distribution<double> normal(0, task_.noise_Vs);
    for (double& scale : scales_Vs) scale += normal(random);
  }
  scales_Vs = within_voltage(file_, scales_Vs);
  Reach reach = reach_with(file_, start, target, scales_Vs, nullptr);
  if (!play(reach, robot_, task_.hand, task_.noise_m, random())) return {};
  const Vec3 end_m = reach.settled_m().value(), off_m = end_m - target;
  std::vector<double> numbers(scales_Vs.begin(), scales_Vs.end());
  numbers.insert(numbers.end(), end_m.begin(), end_m.end());
  numbers.insert(numbers.end(), off_m.begin(), off_m.end());
  return numbers;
}

void ExperienceTraining::round(const Pool& pool) {
  const auto drives = std::ssize(file_.drives.all);
  const auto results =
      pool.map(static_cast<std::size_t>(task_.batch), [&](std::size_t k) { return run_trial(k); });
  Vec3 sum_m = Vec3::Zero();
  int count = 0;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const auto& numbers = results[k];
    if (numbers.empty()) {
      ++tripped_;
      continue;
    }
    const Eigen::Map<const VectorXd> row(numbers.data(), std::ssize(numbers));
    base_.add({static_cast<int>(k / 2 % file_.starts.all.size()), row.head(drives),
               row.segment<3>(drives)});
    if (rounds() > 0 && explores(k)) continue;
    sum_m += row.tail<3>().cwiseAbs(), ++count;
  }
  offset_m_ = sum_m / std::max(1, count);
  ++file_.rounds;
}

std::vector<training_loop::Metric> ExperienceTraining::metrics() const {
  return {
      {"x_mm", 1e3 * offset_m_.x()}, {"y_mm", 1e3 * offset_m_.y()}, {"z_mm", 1e3 * offset_m_.z()}};
}

std::string ExperienceTraining::state() const {
  BaseFile file = file_;
  file.experiences.all = rows_of(base_);
  return xml::write(file);
}

void ExperienceTraining::restore(const std::string& text, const std::string& name) {
  auto saved = xml::parse<BaseFile>(text, name);
  check(saved, std::ssize(robot_.actuators));
  if (saved.seed != file_.seed || saved.starts.all.size() != file_.starts.all.size())
    throw std::invalid_argument(
        name + ": was written with another seed or other starts; resume with the same");
  base_ = base_of(saved);
  saved.experiences.all.clear();
  file_ = std::move(saved);
}

}  // namespace sim::simulated_training
