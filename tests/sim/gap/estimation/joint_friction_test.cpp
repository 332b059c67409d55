#include <catch2/catch.hpp>
#include <cmath>

#include "sim/gap/estimation/as_built.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::estimation;

TEST_CASE("the Coulomb friction of a leg's joints is estimated within 2.5 standard errors") {
  const erp::Robot leg = erp::read_robot(rigs::config("leg/robot.xml"));
  const auto nothing_hidden = sim::blind::draw_case(leg, sim::blind::Kind::null, 1);
  const AsBuilt built = calibrated(leg, blind_recording::episodes(nothing_hidden, 20, 4, leg));
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
