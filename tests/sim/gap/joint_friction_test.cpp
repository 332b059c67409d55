#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "sim/blind/record.hpp"
#include "sim/gap/as_built.hpp"
#include "sim/residuals/episode.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::gap;

namespace {

std::vector<sim::residuals::Episode> recordings_of(const erp::Robot& robot) {
  const auto hidden = sim::blind::draw_case(robot, sim::blind::Kind::null, 1);
  std::vector<sim::residuals::Episode> all;
  std::vector<std::string> remarks;
  for (int k = 0; k < 4; ++k)
    all.push_back(sim::residuals::lay_out(
        sim::blind::record(robot, hidden, sim::excitation(robot, k, 20, 5), std::uint64_t(k)), robot,
        "recording " + std::to_string(k + 1), remarks));
  return all;
}

}  // namespace

TEST_CASE("friction that hides noise where a joint turns back is not estimated larger for that") {
  const erp::Robot leg = erp::read_robot(rigs::config("leg/robot.xml"));
  const AsBuilt built = calibrated(leg, recordings_of(leg));
  int joints = 0;
  for (std::size_t k = 0; k < built.uncertain.constants.size(); ++k) {
    const Constant& c = built.uncertain.constants[k];
    if (c.effect != "joint_coulomb") continue;
    INFO(c.on << " " << c.value(built.estimate.point.x[k]));
    CHECK(std::abs(built.estimate.point.x[k]) < 2.5 * built.estimate.sigma(k));
    ++joints;
  }
  CHECK(joints == 2);
}
