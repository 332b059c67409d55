#pragma once
#include <string>

#include "interfaces/xml/xml.hpp"
#include "sim/learning/sensorimotor/learned_map.hpp"

/// A learned map as a file: `<sensorimotor_learned>`.
namespace sim::sensorimotor {

/// A row of H: one sense, all muscles.
struct SenseRow {
  static constexpr auto element = "sense";
  xml::Place place;
  std::vector<double> weights;
  void visit(auto& v) {
    v.former("ties", "weights");
    v.required("weights", weights);
  }
};
struct GoalRow {
  static constexpr auto element = "goal";
  xml::Place place;
  std::vector<double> at, alpha, errors;
  void visit(auto& v) { v.required("at", at), v.required("alpha", alpha), v("errors", errors); }
};
struct LearnedMapFile {
  static constexpr auto element = "sensorimotor_learned", former_element = "sensorimotor_learnt";
  xml::Place place;
  int rounds = 0;               ///< completed rounds of the training that wrote it
  std::string seed;             ///< of that training
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

LearnedMapFile file_of(const LearnedMap& learned, const std::vector<Goal>& goals);
/// Throws std::invalid_argument if the file has another number of senses or muscles.
LearnedMap learned_map_of(const LearnedMapFile& file, Eigen::Index senses, Eigen::Index muscles);
std::vector<Goal> goals_of(const LearnedMapFile& file, Eigen::Index senses);

}  // namespace sim::sensorimotor
