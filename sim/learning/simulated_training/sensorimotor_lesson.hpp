#pragma once
#include "interfaces/robot/robot.hpp"
#include "sim/learning/training_loop/learner.hpp"
#include "sim/learning/sensorimotor/experiment.hpp"
#include "sim/learning/sensorimotor/eye.hpp"

/// Reaching learnt from twitches, in the simulator without a bus.
namespace sim::simulated_training {

/// A session as it goes on in a robot under its ECUs: force laws there, a frame of images each
/// 10 ms. Muscles at rest pull with their pretension. Throws as World does.
void play(sensorimotor::Session& session, const erp::Robot& robot, const sensorimotor::Eye& eye,
          double noise_px, std::uint64_t seed);

/// Goals that can be reached: where a marker is seen when a few muscles, drawn, pull up to so much
/// above rest for 2 s. Draws again where it is not in every image then.
struct GoalDraw {
  int count = 25, muscles = 3;
  double most_N = 20;
  std::uint64_t seed = 1;
};
std::vector<sensorimotor::GoalAt> reachable_goals(const erp::Robot& robot,
                                                  const sensorimotor::Eye& eye,
                                                  const GoalDraw& draw, const Pool& pool);

/// The first round twitches; each other is one try more of every goal, in worlds of their own.
class SensorimotorLesson : public training_loop::Learner {
 public:
  /// Throws as Eye and goals_of do.
  SensorimotorLesson(const erp::Robot& robot, const cameras::ViewConfig& view,
                     const sensorimotor::Experiment& experiment);

  void round(const Pool& pool) override;
  int rounds() const override { return rounds_; }
  bool done() const override { return rounds_ > experiment_.session.tries; }
  /// Over goals, of their last try: mean and standard deviation of |e|, in senses.
  std::vector<training_loop::Metric> metrics() const override;
  /// A `<sensorimotor_learnt>`.
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

  const sensorimotor::Learnt& learnt() const { return learnt_; }
  const std::vector<sensorimotor::Goal>& goals() const { return goals_; }
  int limited() const { return limited_; }  ///< tries of this run that asked for more than the most

 private:
  void twitch();
  std::vector<double> tried(std::size_t goal) const;
  std::uint64_t seed() const { return static_cast<std::uint64_t>(experiment_.seed); }

  erp::Robot robot_;
  sensorimotor::Eye eye_;
  sensorimotor::Experiment experiment_;
  sensorimotor::Learnt learnt_;
  std::vector<sensorimotor::Goal> goals_;
  int rounds_ = 0, limited_ = 0;
};

}  // namespace sim::simulated_training
