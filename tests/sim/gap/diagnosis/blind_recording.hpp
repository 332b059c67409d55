#pragma once
#include "sim/gap/blind/record.hpp"
#include "sim/gap/residuals/episode.hpp"
#include "tests/sim/rigs.hpp"

/// Recordings of hinge_rig or another robot, simulated by the blind plant with given hidden effects.
namespace blind_recording {

using rigs::hinge_rig;

inline sim::blind::Case nothing_hidden() {
  return sim::blind::draw_case(hinge_rig(), sim::blind::Kind::null, 1);
}

inline std::vector<sim::residuals::Episode> episodes(const sim::blind::Case& blind,
                                                     double seconds = 6, int count = 3,
                                                     const erp::Robot& robot = hinge_rig()) {
  std::vector<sim::residuals::Episode> all;
  std::vector<std::string> remarks;
  for (int k = 0; k < count; ++k)
    all.push_back(sim::residuals::lay_out(
        sim::blind::record(robot, blind, sim::excitation(robot, k, seconds, 5),
                           static_cast<std::uint64_t>(k)),
        robot, "recording " + std::to_string(k + 1), remarks));
  return all;
}

}  // namespace blind_recording
