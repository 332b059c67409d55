#pragma once
#include <string>

#include "interfaces/xml/xml.hpp"
#include "sim/learning/sensorimotor/learned_map.hpp"

/// A learned map as a file: `<sensorimotor_learned>`.
namespace sim::sensorimotor {

/// A row of H: one sense, all muscles.
struct SenseRow {
  static constexpr auto element = "sense";
  static constexpr auto description = "Row of the map, one for each sense.";
  xml::Place place;
  std::vector<double> weights;
  void visit(auto& v) {
    v.former("ties", "weights");
    v.required("weights", weights, "Row of H: association of the sense with each muscle.");
  }
};
struct GoalRow {
  static constexpr auto element = "goal";
  static constexpr auto description = "Goal with its learned gains.";
  xml::Place place;
  std::vector<double> at, alpha, errors;
  void visit(auto& v) {
    v.required("at", at, "Target, by sense.");
    v.required("alpha", alpha, "Gain α, by sense.");
    v("errors", errors, "Remaining error of each trial, in the units of the senses.");
  }
};
struct LearnedMapFile {
  static constexpr auto element = "sensorimotor_learned", former_element = "sensorimotor_learnt";
  static constexpr auto description = "Learned map from muscles to senses.";
  xml::Place place;
  int rounds = 0;
  std::string seed;
  std::vector<double> squares;
  std::vector<SenseRow> senses;
  std::vector<GoalRow> goals;
  void visit(auto& v) {
    v("rounds", rounds, "Completed rounds of the training that wrote the file.");
    v("seed", seed, "Seed of that training.");
    v.required("squares", squares, "N²: sum of the squared forces, by muscle.");
    v.list(senses), v.list(goals);
  }
};

LearnedMapFile file_of(const LearnedMap& learned, const std::vector<Goal>& goals);
/// Throws std::invalid_argument if the file has another number of senses or muscles.
LearnedMap learned_map_of(const LearnedMapFile& file, Eigen::Index senses, Eigen::Index muscles);
std::vector<Goal> goals_of(const LearnedMapFile& file, Eigen::Index senses);

}  // namespace sim::sensorimotor
