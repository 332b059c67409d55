#pragma once
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/learning/sensorimotor/session.hpp"

/// An experiment as a file: `<sensorimotor view="view.xml"> <grid …/> </sensorimotor>`.
namespace sim::sensorimotor {

/// `<grid columns="5" rows="5" half_width="0.25" half_height="0.25"/>`: equally spaced goals
/// about the centre of one camera's image.
struct Grid {
  static constexpr auto element = "grid";
  xml::Place place;
  int columns = 5, rows = 5;
  double half_width = 0, half_height = 0;  ///< in units of the senses
  void visit(auto& v) {
    v("columns", columns, xml::Range{1, 100});
    v("rows", rows, xml::Range{1, 100});
    v.required("half_width", half_width, xml::positive);
    v.required("half_height", half_height, xml::positive);
  }
};

/// `<goal at="0.1 -0.2"/>`: in units of the senses, two per camera.
struct GoalAt {
  static constexpr auto element = "goal";
  xml::Place place;
  std::vector<double> at;
  void visit(auto& v) { v.required("at", at); }
};

struct Experiment {
  static constexpr auto element = "sensorimotor";
  xml::Place place;
  std::string view;       ///< file of cameras and markers, relative to this file
  double noise_px = 0.1;  ///< noise of a marker's position in the simulator's images
  int seed = 1;
  SessionOptions session;
  std::vector<Grid> grids;
  std::vector<GoalAt> goals;
  void visit(auto& v) {
    v.former("tries", "trials"), v.former("little", "regularization");
    v.required("view", view);
    v("noise_px", noise_px, xml::at_least_zero);
    v("seed", seed, xml::Range{0, 1e9});
    v("twitches", session.twitches, xml::Range{0, 1e5});
    v("trials", session.trials, xml::Range{0, 1e5});
    v("twitch_N", session.twitch_N, xml::positive);
    v("twitch_s", session.twitch_s, xml::positive);
    v("pause_s", session.pause_s, xml::positive);
    v("relax_s", session.relax_s, xml::positive);
    v("reach_s", session.reach_s, xml::positive);
    v("mean_s", session.mean_s, xml::positive);
    v("most_N", session.most_N, xml::positive);
    v("rate", session.reach.rate, xml::Range{0, 2});
    v("regularization", session.reach.regularization, xml::positive);
    v.list(grids), v.list(goals);
  }
};

/// Grids first, row by row from the upper left. Throws std::invalid_argument if a goal has another
/// number of senses.
std::vector<Goal> goals_of(const Experiment& experiment, Eigen::Index senses);

}  // namespace sim::sensorimotor
