#pragma once
#include <limits>

#include "sim/learning/training_loop/learner.hpp"
#include "sim/learning/synergy/task.hpp"

/// Striking a bottle by motor plans, learnt in the simulator without a bus (paper, 5.5).
namespace sim::simulated_training {

/// A trial, way back and all, as it goes on in a robot under its ECUs. False: it was not played to its
/// end, since an ECU tripped or the motion was not finite. Throws as World does.
bool play(synergy::Trial& trial, const erp::Robot& robot, const HandConfig& hand,
          const std::vector<std::size_t>& muscles, std::uint64_t seed);

/// Each round tries random targets of the zone with what the bank makes of them, every second plan
/// varied; what a trial teaches is in `synergy::Taught`. One that was not played to its end teaches what
/// one does from which the hand did not come back.
class SynergyLesson : public training_loop::Learner {
 public:
  /// Begins with a plan for each pose, made by statics: rough. Throws std::invalid_argument as
  /// PoseHolder, Hand and actuators_of do.
  SynergyLesson(const erp::Robot& robot, const synergy::Task& task, const std::vector<Pose>& poses);

  void round(const Pool& pool) override;
  int rounds() const override { return file_.rounds; }
  bool done() const override { return rounds() >= task_.rounds; }
  /// Of the last round's plans that were not varied: how many struck, from how many the hand came back,
  /// what they were rewarded with; NaN: no round yet.
  std::vector<training_loop::Metric> metrics() const override;
  /// A `<synergy_bank>`.
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

  const synergy::Bank& bank() const { return bank_; }
  const synergy::BankFile& file() const { return file_; }

  /// A fresh target and what a bank, noise and all, makes of it.
  struct Test {
    Vec3 target_m;
    bool came_back = false;
    synergy::Outcome outcome;
    double relative_jerk = 0;
  };
  Test test(const synergy::Bank& bank, std::uint64_t seed, std::size_t number) const;

 private:
  struct Try;
  Try planned(std::size_t place) const;
  std::vector<double> tried(Try one) const;
  synergy::Taught played(synergy::Trial& trial, const Vec3& target_m, std::uint64_t seed) const;
  void add_rough_plans(const std::vector<Pose>& poses);
  std::uint64_t seed() const { return static_cast<std::uint64_t>(task_.seed); }

  erp::Robot robot_;
  synergy::Task task_;
  synergy::BankFile file_;
  std::vector<std::size_t> muscles_;
  synergy::Bank bank_;
  double struck_ = std::numeric_limits<double>::quiet_NaN();  ///< before a round
  double came_back_ = struck_, reward_ = struck_;
};

}  // namespace sim::simulated_training
