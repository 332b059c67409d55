#pragma once
#include <string>

#include "interfaces/xml/xml.hpp"
#include "sim/learning/sensorimotor/learnt.hpp"

/// What has been learnt, as a file: `<sensorimotor_learnt>`.
namespace sim::sensorimotor {

/// A row of H: one sense, by muscle.
struct SenseRow {
  static constexpr auto element = "sense";
  xml::Place place;
  std::vector<double> ties;
  void visit(auto& v) { v.required("ties", ties); }
};
struct GoalRow {
  static constexpr auto element = "goal";
  xml::Place place;
  std::vector<double> at, alpha, errors;
  void visit(auto& v) { v.required("at", at), v.required("alpha", alpha), v("errors", errors); }
};
struct LearntFile {
  static constexpr auto element = "sensorimotor_learnt";
  xml::Place place;
  int rounds = 0;               ///< of the lesson that wrote it
  std::string seed;             ///< of that
  std::vector<double> squares;  ///< N², by muscle
  std::vector<SenseRow> senses;
  std::vector<GoalRow> goals;
  void visit(auto& v) {
    v("rounds", rounds);
    v("seed", seed);
    v.required("squares", squares);
    v.list(senses), v.list(goals);
  }
};

LearntFile file_of(const Learnt& learnt, const std::vector<Goal>& goals);
/// Throws std::invalid_argument: not of so many senses and muscles.
Learnt learnt_of(const LearntFile& file, Eigen::Index senses, Eigen::Index muscles);
std::vector<Goal> goals_of(const LearntFile& file, Eigen::Index senses);

}  // namespace sim::sensorimotor
