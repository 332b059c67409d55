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
  static constexpr auto description =
      "Equally spaced goals about the centre of one camera's image.";
  xml::Place place;
  int columns = 5, rows = 5;
  double half_width = 0, half_height = 0;
  void visit(auto& v) {
    v("columns", columns, {xml::Range{1, 100}, "Number of columns of goals."});
    v("rows", rows, {xml::Range{1, 100}, "Number of rows of goals."});
    v.required(
        "half_width", half_width,
        {xml::positive,
         "Distance of the outer columns from the centre of the image, in units of the senses."});
    v.required(
        "half_height", half_height,
        {xml::positive,
         "Distance of the outer rows from the centre of the image, in units of the senses."});
  }
};

/// `<goal at="0.1 -0.2"/>`: in units of the senses, two per camera.
struct GoalAt {
  static constexpr auto element = "goal";
  static constexpr auto description = "One goal.";
  xml::Place place;
  std::vector<double> at;
  void visit(auto& v) {
    v.required("at", at,
               "Position of the marker in the images, in units of the senses, two per camera.");
  }
};

struct Experiment {
  static constexpr auto element = "sensorimotor";
  xml::Place place;
  std::string view;
  double noise_px = 0.1;
  int seed = 1;
  SessionOptions session;
  std::vector<Grid> grids;
  std::vector<GoalAt> goals;
  void visit(auto& v) {
    v.former("tries", "trials"), v.former("little", "regularization");
    v.required("view", view,
               "File of cameras and markers, a <camera_view>, relative to the config.");
    v("noise_px", noise_px,
      {xml::at_least_zero, "Noise of a marker's position in the images of the simulator."});
    v("seed", seed, {xml::Range{0, 1e9}, "Seed of noise and twitches."});
    v("twitches", session.twitches,
      {xml::Range{0, 1e5}, "Number of twitches; 0: none, the given map is used."});
    v("trials", session.trials, {xml::Range{0, 1e5}, "Number of trials of each goal; 0: none."});
    v("twitch_N", session.twitch_N,
      {xml::positive, "Largest force of a twitch; the smallest is half of it; chosen."});
    v("twitch_s", session.twitch_s, {xml::positive, "Length of a twitch; chosen."});
    v("pause_s", session.pause_s, {xml::positive, "Pause after a twitch; chosen."});
    v("relax_s", session.relax_s, {xml::positive, "Time at rest before a trial; chosen."});
    v("reach_s", session.reach_s, {xml::positive, "Length of a trial; chosen."});
    v("mean_s", session.mean_s,
      {xml::positive, "Averaging time at the end of rest and trial; chosen."});
    v("most_N", session.most_N,
      {xml::positive,
       "Limit of the force above rest; trials that exceed it are scaled down and counted; "
       "chosen."});
    v("rate", session.reach.rate, {xml::Range{0, 2}, "Rate η of the gains; chosen."});
    v("regularization", session.reach.regularization,
      {xml::positive,
       "Distance ε of a goal along a sense, in its units, below which its gain hardly changes; "
       "chosen."});
    v.list(grids), v.list(goals);
  }
};

/// Grids first, row by row from the upper left. Throws std::invalid_argument if a goal has another
/// number of senses.
std::vector<Goal> goals_of(const Experiment& experiment, Eigen::Index senses);

}  // namespace sim::sensorimotor
