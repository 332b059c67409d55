// The steps of controllers do not use the heap, from the second step on.
#include <catch2/catch.hpp>

#include "components/computed_force/computed_force.hpp"
#include "components/pose_estimator/pose_estimator.hpp"
#include "components/puller_follower/puller_follower.hpp"
#include "tests/allocations.hpp"
#include "tests/components/joint_bench.hpp"

namespace {

struct Bench : JointBench {
  explicit Bench(const std::string& name) : JointBench(name + "/robot.xml") {}
  /// Changes all inputs slightly, so that constraints become active and inactive.
  void wiggle(int k) {
    const double change = 0.02 * std::sin(0.3 * k);
    for (auto& sample : erp::samples(state.message.joints)) sample.velocity_rad_per_s[0] = change;
    for (auto& sample : erp::samples(target.message.joints))
      sample.acceleration_rad_per_s2[0] = 50 * change;
    for (auto& sample : erp::samples(frame.actuators)) sample.shaft_rad = change;
  }
};

/// Performs forty steps; the heap must not be used from the third step on.
template <class Step>
void check_heap(Bench& bench, Step step) {
  std::size_t before = 0;
  int commands = 0;
  for (int k = 0; k < 40; ++k) {
    bench.wiggle(k);
    if (k == 2) before = tests::allocations();
    commands += step();
  }
  const std::size_t after = tests::allocations();
  INFO(bench.robot.name);
  CHECK(after == before);
  CHECK(commands == 40);
}

}  // namespace

TEST_CASE("computed force and the pose estimator do not use the heap") {
  for (const std::string name : {"arm", "ecce4"}) {
    Bench bench(name);
    control::ComputedForce control({}, bench.robot);
    pose::PoseEstimator estimator({}, bench.robot);
    check_heap(bench, [&] {
      estimator.step(bench.frame, 0.002, {}, {});
      return control.step(bench.frame, 0.002, bench.state, bench.target).has_value();
    });
  }
}

TEST_CASE("a Jacobian that is learned online does not use the heap") {
  Bench bench("arm");
  control::ComputedForce::Params params;
  params.jacobian = control::JacobianKind::on_line;
  control::ComputedForce control(params, bench.robot);
  check_heap(bench, [&] {
    return control.step(bench.frame, 0.002, bench.state, bench.target).has_value();
  });
}

TEST_CASE("puller-follower does not use the heap") {
  Bench bench("seven_dof");
  for (const auto law : {control::Law::linearised, control::Law::loop_shaping}) {
    control::PullerFollower::Params params;
    params.law = law;
    control::PullerFollower control(params, bench.robot);
    check_heap(bench, [&] {
      return control.step(bench.frame, 0.002, bench.state, bench.target).has_value();
    });
  }
}
