#pragma once
#include <limits>

#include "sim/learner/learner.hpp"
#include "sim/synergy/task.hpp"

/// Striking a bottle by motor plans, learnt in the simulator without a bus (paper, 5.5).
namespace sim::lessons {

/// A trial as it goes on in a robot under its ECUs, which begins as it starts and at rest: no way back
/// is needed. False: an ECU tripped. Throws as World does.
bool play(synergy::Trial& trial, const erp::Robot& robot, const HandConfig& hand,
          const std::vector<std::size_t>& muscles, std::uint64_t seed);

/// Each round tries random targets of the zone with what the bank makes of them, every second plan
/// varied; contributors are credited with the reward, and each plan is stored with the place to which
/// it brought the hand, valued as if that had been its target.
class SynergyLesson : public learner::Learner {
 public:
  /// Begins with a plan for each pose, made by statics: rough. Throws std::invalid_argument as
  /// PoseHolder, Hand and actuators_of do.
  SynergyLesson(const erp::Robot& robot, const synergy::Task& task, const std::vector<Pose>& poses);

  void round(const Pool& pool) override;
  int rounds() const override { return file_.rounds; }
  bool done() const override { return rounds() >= task_.rounds; }
  /// Of the last round's plans that were not varied: how many struck, what they were rewarded with;
  /// NaN: no round yet.
  std::vector<learner::Metric> metrics() const override;
  /// A `<synergy_bank>`.
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

  const synergy::Bank& bank() const { return bank_; }
  const synergy::BankFile& file() const { return file_; }
  int tripped() const { return tripped_; }

  /// A fresh target and what a bank, noise and all, makes of it.
  struct Test {
    Vec3 target_m;
    bool tripped = false;
    synergy::Outcome outcome;
    double relative_jerk = 0;
  };
  Test test(const synergy::Bank& bank, std::uint64_t seed, std::size_t number) const;

 private:
  struct Try;
  Try planned(std::size_t place) const;
  std::vector<double> tried(Try one) const;
  void add_rough_plans(const std::vector<Pose>& poses);
  std::uint64_t seed() const { return static_cast<std::uint64_t>(task_.seed); }

  erp::Robot robot_;
  synergy::Task task_;
  synergy::BankFile file_;
  std::vector<std::size_t> muscles_;
  synergy::Bank bank_;
  double struck_ = std::numeric_limits<double>::quiet_NaN(), reward_ = struck_;  ///< before a round
  int tripped_ = 0;
};

}  // namespace sim::lessons
