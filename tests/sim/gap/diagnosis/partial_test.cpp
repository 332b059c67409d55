#include <catch2/catch.hpp>

#include "sim/gap/diagnosis/isolation.hpp"
#include "sim/gap/residuals/common_signals.hpp"
#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

namespace effects = sim::effects;
using namespace sim::diagnosis;
using namespace sim::residuals;

namespace {

using rigs::hinge_rig;

Episode recorded(const std::vector<effects::Placed>& placed, std::uint64_t seed = 7) {
  erp::Robot real = hinge_rig();
  for (const auto& p : placed) real.effects.push_back(effects::written(p));
  return rig_recording::record(hinge_rig(), real, {.seconds = 12, .seed = seed});
}

void check_no_gap(const std::vector<Episode>& episodes) {
  for (const StageGap& gap : localize(hinge_rig(), episodes)) {
    INFO(effects::word(gap.stage) << " " << gap.on << ": excess " << gap.excess);
    CHECK_FALSE(gap.open);
    CHECK(gap.rms < 1.4 * gap.floor);
  }
}

std::vector<std::string> isolated(const std::vector<effects::Placed>& hidden,
                                  const std::vector<std::string>& withhold = {}) {
  const erp::Robot robot = hinge_rig();
  Problem problem{robot, {recorded(hidden)}, {.withhold = withhold}, {{0}, {0}}};
  std::vector<std::string> names;
  for (const Part& part : isolate(problem, Evaluator(robot, problem.episodes)))
    names.push_back(std::string(effects::word(part.stage)) + " " + part.on);
  return names;
}

}  // namespace

TEST_CASE("signals that one recording lacks are removed from all recordings with a remark") {
  std::vector<Episode> episodes{recorded({}), recorded({}, 8)};
  episodes[0].name = "monday.csv", episodes[1].name = "tuesday.csv";
  episodes[1].actuators[0].tension_N.clear();
  std::ranges::fill(episodes[0].actuators[1].current_A, recording::not_taken);
  std::vector<std::string> remarks;
  keep_common(episodes, hinge_rig(), remarks);
  REQUIRE(remarks.size() == 2);
  CHECK_THAT(remarks[0], Catch::StartsWith("tuesday.csv: lacks flexor.tension_N"));
  CHECK_THAT(remarks[1], Catch::StartsWith("monday.csv: lacks extensor.current_A"));
  CHECK(episodes[0].actuators[0].tension_N.empty());
  CHECK(episodes[1].actuators[1].current_A.empty());
  check_no_gap(episodes);
}

TEST_CASE("an unmeasured joint angle is estimated from tendons within 0.003 rad") {
  Episode episode = recorded({});
  const Signal truth = episode.joints[0].angle_rad;
  episode.joints[0].angle_rad.clear();
  const auto joints = Stages(hinge_rig()).explain(episode).joints;
  REQUIRE(joints->estimated);
  const Signal& estimated = joints->signals[0].angle_rad;
  for (std::size_t k = 100; k + 100 < truth.size(); k += 50)
    CHECK(estimated[k] == Approx(truth[k]).margin(0.003));
  check_no_gap({episode});
}

TEST_CASE(
    "without joint angles a wrong spindle radius opens the tendon stage, and slack tendons give no "
    "angle") {
  Episode episode = recorded({{"extensor", effects::SpindleRadius{0.1}}});
  episode.joints[0].angle_rad.clear();
  const Episode all[] = {episode};
  CHECK(localize(hinge_rig(), all)[0].stage == effects::Stage::tendon);
  CHECK(localize(hinge_rig(), all)[0].open);
  for (auto& a : episode.actuators) std::ranges::fill(a.tension_N, 0.0);
  const auto joints = Stages(hinge_rig()).explain(episode).joints;
  CHECK(std::isnan(joints->signals[0].angle_rad[1000]));
}

TEST_CASE("an unmeasured current is computed from the motor's law and causes no gap") {
  Episode episode = recorded({});
  for (auto& a : episode.actuators) a.current_A.clear();
  check_no_gap({episode});
}

TEST_CASE("isolation lists the part with the effect, but no part whose effects open other stages") {
  using Names = std::vector<std::string>;
  const Names friction_parts = isolated({{"flexor", effects::GearboxCoulomb{0.1}}});
  CHECK(std::ranges::count(friction_parts, "gearbox flexor") == 1);
  for (const char* other : {"gearbox extensor", "tendon flexor", "spindle flexor", "joint elbow"})
    CHECK(std::ranges::count(friction_parts, other) == 0);
  const Names damping_parts = isolated({{"elbow", effects::JointViscous{0.2}}});
  CHECK(std::ranges::count(damping_parts, "joint elbow") == 1);
  for (const std::string& name : damping_parts) {
    INFO(name);
    CHECK((name.starts_with("joint") || name.starts_with("skeleton")));
  }
}

TEST_CASE("isolation ignores withheld effects") {
  std::vector<std::string> joint_types;
  for (const auto& effect : effects::library())
    if (effects::about(effect).stage == effects::Stage::joint)
      joint_types.emplace_back(effects::about(effect).type);
  for (const std::string& name : isolated({{"elbow", effects::JointViscous{0.2}}}, joint_types)) {
    INFO(name);
    CHECK_FALSE(name.starts_with("joint"));
  }
}
