#pragma once
#include <limits>

#include "sim/learning/experience/base_file.hpp"
#include "sim/learning/experience/task.hpp"
#include "sim/learning/training_loop/learner.hpp"
#include "sim/model/skeleton/joint_path.hpp"

/// Experience acquired in the simulator without a bus, and what it is good for.
namespace sim::simulated_training {

/// The hand while a reach goes on.
struct HandTrack {
  std::vector<double> time_s;
  std::vector<Vec3> hand_m;
};

/// A reach as it goes on in a robot under its ECUs; the hand is seen with noise. False: an ECU
/// tripped. Throws as World does.
bool play(experience::Reach& reach, const erp::Robot& robot, const HandConfig& hand, double noise_m,
          std::uint64_t seed, HandTrack* track = nullptr);

/// Starting from nothing, each round tries targets of the zone with what is known so far, every
/// second try with noise on its scales; wherever a try leads is an experience. So it grows about
/// where it is used ("goal babbling": Rolf, Steil, Gienger 2010), with one answer for each place
/// though the arm has many.
class ExperienceLesson : public training_loop::Learner {
 public:
  /// Throws std::invalid_argument as drives_of, Hand, Patterns and, of the starts, hold_pose do.
  ExperienceLesson(const erp::Robot& robot, const experience::Task& task,
                   const std::vector<Pose>& starts);

  void round(const Pool& pool) override;
  int rounds() const override { return file_.rounds; }
  bool done() const override { return rounds() >= task_.rounds; }
  /// Mean offsets of the last round's tries without noise, settled, no feedback; NaN: no round yet.
  std::vector<training_loop::Metric> metrics() const override;
  /// An `<experience_base>`.
  std::string state() const override;
  void restore(const std::string& text, const std::string& file) override;

  const experience::Base& base() const { return base_; }
  const experience::BaseFile& file() const { return file_; }
  int tripped() const { return tripped_; }  ///< tries that an ECU ended

  /// A target of the zone that nothing was learnt with.
  Vec3 fresh_target(std::uint64_t seed, std::size_t number) const;
  experience::Reach reach(int start, const Vec3& target_m,
                          std::shared_ptr<const experience::Feedback> feedback) const;

 private:
  std::vector<double> tried(std::size_t place) const;
  bool explores(std::size_t place) const { return rounds() == 0 || place % 2 == 1; }
  std::uint64_t seed() const { return static_cast<std::uint64_t>(task_.seed); }

  erp::Robot robot_;
  experience::Task task_;
  experience::BaseFile file_;
  experience::Base base_;
  Vec3 offset_m_ = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< before a round
  int tripped_ = 0;
};

}  // namespace sim::simulated_training
