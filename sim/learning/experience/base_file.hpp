#pragma once
#include "interfaces/xml/xml.hpp"
#include "sim/learning/experience/reach.hpp"
#include "sim/model/skeleton/hand.hpp"

/// All data of a reach, as a file: `<experience_base>`.
namespace sim::experience {

/// A starting posture: `<start line_m="…"/>`, line lengths by actuator.
struct StartRow {
  static constexpr auto element = "start", plural = "starts";
  static constexpr auto description = "Starting posture.";
  xml::Place place;
  std::vector<double> line_m;
  void visit(auto& v) { v.required("line_m", line_m, "Line length of each actuator."); }
};
struct ExperienceRow {
  static constexpr auto element = "experience", plural = "experiences";
  static constexpr auto description = "Reach with its result.";
  xml::Place place;
  int start = 0;
  std::vector<double> scales_Vs;
  xml::Vec3 end_m{};
  void visit(auto& v) {
    v("start", start, {xml::Range{0, 1e6}, "Number of the starting posture, from 0."});
    v.required("scales_Vs", scales_Vs, "Scale of each drive.");
    v.required("end_m", end_m, "Position that the hand reached, in the world.");
  }
};
struct BaseFile {
  static constexpr auto element = "experience_base";
  static constexpr auto description = "Stored experiences, and all that a reach needs.";
  xml::Place place;
  int rounds = 0;
  std::string seed;
  double pattern_V = 10;
  ReachTimes times;
  HandConfig hand;
  xml::Plural<Burst> bursts;
  xml::Plural<Drive> drives;
  xml::Plural<StartRow> starts;
  xml::Plural<ExperienceRow> experiences;
  void visit(auto& v) {
    v("rounds", rounds, "Completed rounds of the training that wrote the file.");
    v("seed", seed, "Seed of that training.");
    v("pattern_V", pattern_V,
      {xml::positive,
       "Largest pattern voltage of a muscle; targets that need more are out of reach."});
    times.visit(v);
    v.child(hand);
    v.child(bursts), v.child(drives), v.child(starts), v.child(experiences);
  }
};

Base base_of(const BaseFile& file);
std::vector<ExperienceRow> rows_of(const Base& base);
/// Throws std::invalid_argument with place, value and expected value if the number of muscles or
/// drives differs, if an experience names a start that does not exist, or if there is no start.
void check(const BaseFile& file, Eigen::Index muscles);

/// A reach from a start with the given scales. `file` must have passed `check`.
Reach reach_with(const BaseFile& file, int start, const Eigen::Vector3d& target_m,
                 const Eigen::VectorXd& scales_Vs, std::shared_ptr<const Feedback> feedback);

/// Largest voltage that a pattern with these scales applies to any muscle, in V.
double peak_V(const BaseFile& file, const Eigen::VectorXd& scales_Vs);
/// The scales, reduced by a common factor if their peak voltage exceeds `pattern_V`.
Eigen::VectorXd within_voltage(const BaseFile& file, const Eigen::VectorXd& scales_Vs);

}  // namespace sim::experience
