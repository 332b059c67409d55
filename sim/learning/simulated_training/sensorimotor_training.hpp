#pragma once
#include "interfaces/robot/robot.hpp"
#include "sim/learning/sensorimotor/experiment.hpp"
#include "sim/learning/sensorimotor/eye.hpp"
#include "sim/learning/training_loop/training_loop.hpp"

/// Learns reaching from twitches in the simulator without a bus.
namespace sim::simulated_training {

/// Runs a session on a simulated robot with its ECUs, which run their force laws; one frame of
/// images each 10 ms. Muscles at rest pull with their pretension. Throws like World.
void play(sensorimotor::Session& session, const erp::Robot& robot, const sensorimotor::Eye& eye,
          double noise_px, std::uint64_t seed);

/// Draws reachable goals: the positions of the marker after a few random muscles have pulled for 2
/// s with up to `most_N` above rest. Draws again if the marker is not in every image.
struct GoalDraw {
  int count = 25, muscles = 3;
  double most_N = 20;
  std::uint64_t seed = 1;
};
std::vector<sensorimotor::GoalAt> reachable_goals(const erp::Robot& robot,
                                                  const sensorimotor::Eye& eye,
                                                  const GoalDraw& draw, const Pool& pool);

/// The first round twitches. Each further round is one more trial of every goal, each in its own
/// simulation.
class SensorimotorTraining : public training_loop::Training {
 public:
  /// Throws like Eye and goals_of.
  SensorimotorTraining(const erp::Robot& robot, const cameras::ViewConfig& view,
                       const sensorimotor::Experiment& experiment);

  void round(const Pool& pool) override;
  int rounds() const override { return rounds_; }
  bool done() const override { return rounds_ > experiment_.session.trials; }
  /// Mean and standard deviation over goals of |e| in the last trial, in units of the senses.
  std::vector<training_loop::Metric> metrics() const override;
  /// A `<sensorimotor_learned>`.
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

  const sensorimotor::LearnedMap& learned() const { return learned_; }
  const std::vector<sensorimotor::Goal>& goals() const { return goals_; }
  int limited() const { return limited_; }  ///< trials of this run that exceeded the force limit

 private:
  void twitch();
  std::vector<double> run_trial(std::size_t goal) const;
  std::uint64_t seed() const { return static_cast<std::uint64_t>(experiment_.seed); }

  erp::Robot robot_;
  sensorimotor::Eye eye_;
  sensorimotor::Experiment experiment_;
  sensorimotor::LearnedMap learned_;
  std::vector<sensorimotor::Goal> goals_;
  int rounds_ = 0, limited_ = 0;
};

}  // namespace sim::simulated_training
