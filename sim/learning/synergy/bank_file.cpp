#include "sim/learning/synergy/bank_file.hpp"

#include <algorithm>
#include <stdexcept>

namespace sim::synergy {
namespace {

[[noreturn]] void reject(const xml::Place& place, const std::string& what) {
  throw std::invalid_argument(place.file + ":" + std::to_string(place.line) + ": " + what);
}

}  // namespace

Bank bank_of(const BankFile& file) {
  std::vector<MotorPlan> plans;
  for (const PlanRow& row : file.plans.all)
    plans.push_back(
        {Eigen::Map<const Eigen::VectorXd>(row.weights_m.data(), std::ssize(row.weights_m)),
         {row.rise_s, row.overshoot},
         vec(row.at_m),
         row.value});
  return {file.options, std::move(plans)};
}

std::vector<PlanRow> rows_of(const Bank& bank) {
  std::vector<PlanRow> rows;
  for (const MotorPlan& plan : bank.plans())
    rows.push_back({{},
                    numbers(plan.at_m),
                    plan.value,
                    plan.signal.rise_s,
                    plan.signal.overshoot,
                    {plan.weights_m.begin(), plan.weights_m.end()}});
  return rows;
}

std::string text_of(BankFile file, const Bank& bank) {
  file.plans.all = rows_of(bank);
  return xml::write(file);
}

std::vector<std::size_t> actuators_of(const std::vector<LearnedMuscle>& muscles,
                                      const erp::Robot& robot) {
  std::vector<std::size_t> actuators;
  for (const LearnedMuscle& learned : muscles) {
    const auto actuator = std::ranges::find(robot.actuators, learned.muscle, &erp::Actuator::name);
    if (actuator == robot.actuators.end())
      reject(learned.place, "the robot has no muscle \"" + learned.muscle + "\"");
    actuators.push_back(static_cast<std::size_t>(actuator - robot.actuators.begin()));
  }
  return actuators;
}

void check(const BankFile& file) {
  if (file.plans.all.empty()) reject(file.place, "a <synergy_bank> has at least one <plan>");
  for (const PlanRow& row : file.plans.all)
    if (row.weights_m.size() != file.muscles.all.size())
      reject(row.place, std::to_string(row.weights_m.size()) + " weights, but there are " +
                            std::to_string(file.muscles.all.size()) + " <learned> muscles");
}

}  // namespace sim::synergy
