#pragma once
#include <limits>

#include "sim/learning/synergy/task.hpp"
#include "sim/learning/training_loop/training_loop.hpp"

/// Learns motor plans that strike a bottle, in the simulator without a bus (paper, 5.5).
namespace sim::simulated_training {

/// Runs a trial, return included, on a simulated robot with its ECUs. False: the trial was aborted
/// because an ECU tripped or the motion was not finite. Throws like World.
bool play(synergy::Trial& trial, const erp::Robot& robot, const HandConfig& hand,
          const std::vector<std::size_t>& muscles, std::uint64_t seed);

/// Each round blends plans for random targets of the zone and runs them, every second plan varied.
/// `synergy::TrialResult` describes what the bank learns from a trial. An aborted trial counts as
/// one from which the hand did not return.
class SynergyTraining : public training_loop::Training {
 public:
  /// Begins with one rough plan for each pose, computed by statics. Throws std::invalid_argument
  /// like PoseHolder, Hand and actuators_of.
  SynergyTraining(const erp::Robot& robot, const synergy::Task& task,
                  const std::vector<Pose>& poses);

  void round(const Pool& pool) override;
  int rounds() const override { return file_.rounds; }
  bool done() const override { return rounds() >= task_.rounds; }
  /// Of the last round's plans that were not varied: fraction that struck, fraction from which the
  /// hand returned, mean reward; NaN before the first round.
  std::vector<training_loop::Metric> metrics() const override;
  /// A `<synergy_bank>`.
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

  const synergy::Bank& bank() const { return bank_; }
  const synergy::BankFile& file() const { return file_; }

  /// Result of a bank's plan, with noise, for a target that was not used in the training.
  struct Test {
    Vec3 target_m;
    bool returned = false;
    synergy::Outcome outcome;
    double relative_jerk = 0;
  };
  Test test(const synergy::Bank& bank, std::uint64_t seed, std::size_t number) const;

 private:
  struct PlannedTrial;
  PlannedTrial plan_trial(std::size_t index) const;
  std::vector<double> run_trial(PlannedTrial planned) const;
  synergy::TrialResult play_trial(synergy::Trial& trial, const Vec3& target_m,
                                  std::uint64_t seed) const;
  void add_rough_plans(const std::vector<Pose>& poses);
  std::uint64_t seed() const { return static_cast<std::uint64_t>(task_.seed); }

  erp::Robot robot_;
  synergy::Task task_;
  synergy::BankFile file_;
  std::vector<std::size_t> muscles_;
  synergy::Bank bank_;
  double struck_ = std::numeric_limits<double>::quiet_NaN();  ///< NaN before the first round
  double returned_ = struck_, reward_ = struck_;
};

}  // namespace sim::simulated_training
