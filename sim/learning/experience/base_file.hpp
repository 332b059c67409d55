#pragma once
#include "interfaces/xml/xml.hpp"
#include "sim/learning/experience/reach.hpp"
#include "sim/model/skeleton/hand.hpp"

/// All that a reach needs, as a file: `<experience_base>`.
namespace sim::experience {

/// Where reaches start: `<start line_m="…"/>`, by actuator.
struct StartRow {
  static constexpr auto element = "start", plural = "starts";
  xml::Place place;
  std::vector<double> line_m;
  void visit(auto& v) { v.required("line_m", line_m); }
};
struct ExperienceRow {
  static constexpr auto element = "experience", plural = "experiences";
  xml::Place place;
  int start = 0;
  std::vector<double> scales_Vs;
  xml::Vec3 end_m{};
  void visit(auto& v) {
    v("start", start, xml::Range{0, 1e6});
    v.required("scales_Vs", scales_Vs);
    v.required("end_m", end_m);
  }
};
struct BaseFile {
  static constexpr auto element = "experience_base";
  xml::Place place;
  int rounds = 0;  ///< of the lesson that wrote it
  std::string seed;
  double pattern_V = 10;  ///< no muscle is given more by a pattern; more is out of reach
  ReachTimes times;
  HandConfig hand;
  xml::Plural<Burst> bursts;
  xml::Plural<Drive> drives;
  xml::Plural<StartRow> starts;
  xml::Plural<ExperienceRow> experiences;
  void visit(auto& v) {
    v("rounds", rounds);
    v("seed", seed);
    v("pattern_V", pattern_V, xml::positive);
    times.visit(v);
    v.child(hand);
    v.child(bursts), v.child(drives), v.child(starts), v.child(experiences);
  }
};

Base base_of(const BaseFile& file);
std::vector<ExperienceRow> rows_of(const Base& base);
/// Throws std::invalid_argument, naming place, value and what is expected: of other muscles, an
/// experience of other drives or of a start that there is not, no start at all.
void check(const BaseFile& file, Eigen::Index muscles);

/// A reach from a start with such scales. `file` as checked.
Reach reach_with(const BaseFile& file, int start, const Eigen::Vector3d& target_m,
                 const Eigen::VectorXd& scales_Vs, std::shared_ptr<const Feedback> feedback);

/// The most that a pattern of such scales gives a muscle, V.
double peak_V(const BaseFile& file, const Eigen::VectorXd& scales_Vs);
/// Scaled down as a whole until that is no more than `pattern_V`.
Eigen::VectorXd within_voltage(const BaseFile& file, const Eigen::VectorXd& scales_Vs);

}  // namespace sim::experience
