#pragma once
#include <limits>

#include "sim/learning/experience/base_file.hpp"
#include "sim/learning/experience/task.hpp"
#include "sim/learning/training_loop/training_loop.hpp"
#include "sim/model/skeleton/joint_path.hpp"

/// Acquires experience in the simulator without a bus, and tests it.
namespace sim::simulated_training {

/// Path of the hand during a reach.
struct HandTrack {
  std::vector<double> time_s;
  std::vector<Vec3> hand_m;
};

/// Runs a reach on a simulated robot with its ECUs; the hand position is measured with noise.
/// Returns false if an ECU tripped. Throws like World.
bool play(experience::Reach& reach, const erp::Robot& robot, const HandConfig& hand, double noise_m,
          std::uint64_t seed, HandTrack* track = nullptr);

/// The base starts empty. Each round reaches for random targets of the zone with the current
/// inverse model, every second trial with noise on its scales. Each trial is stored with the place
/// that the hand reached. The base therefore grows in the region where it is used ("goal babbling":
/// Rolf, Steil, Gienger 2010). It has one solution for each place, although a redundant arm has
/// many.
class ExperienceTraining : public training_loop::Training {
 public:
  /// Throws std::invalid_argument like drives_of, Hand, Patterns and, for the starts, hold_pose.
  ExperienceTraining(const erp::Robot& robot, const experience::Task& task,
                     const std::vector<Pose>& starts);

  void round(const Pool& pool) override;
  int rounds() const override { return file_.rounds; }
  bool done() const override { return rounds() >= task_.rounds; }
  /// Mean offset from the target in the last round's trials without noise and without feedback; NaN
  /// before the first round.
  std::vector<training_loop::Metric> metrics() const override;
  /// An `<experience_base>`.
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

  const experience::Base& base() const { return base_; }
  const experience::BaseFile& file() const { return file_; }
  int tripped() const { return tripped_; }  ///< trials ended by an ECU that tripped

  /// A random target of the zone that was not used in the training.
  Vec3 fresh_target(std::uint64_t seed, std::size_t number) const;
  experience::Reach reach(int start, const Vec3& target_m,
                          std::shared_ptr<const experience::Feedback> feedback) const;

 private:
  std::vector<double> run_trial(std::size_t index) const;
  bool explores(std::size_t index) const { return rounds() == 0 || index % 2 == 1; }
  std::uint64_t seed() const { return static_cast<std::uint64_t>(task_.seed); }

  erp::Robot robot_;
  experience::Task task_;
  experience::BaseFile file_;
  experience::Base base_;
  /// NaN before the first round.
  Vec3 offset_m_ = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  int tripped_ = 0;
};

}  // namespace sim::simulated_training
