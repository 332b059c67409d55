#include "components/reference/joint_player.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/interfaces/recording/support.hpp"

namespace {

constexpr double period_s = 0.002;
constexpr std::int64_t period_ns = 2'000'000;

/// A player that guides the arm's elbow from 0.3 to 1.3 rad in one second, and an arm whose
/// position the test sets.
struct Fixture {
  test::Folder folder;
  erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/arm/robot.xml");
  joints::Names names{robot};
  reference::JointPlayer player = make_player();
  node::Latest<erp::JointState> state;
  erp::SensorFrame frame;

  reference::JointPlayer make_player() {
    std::ofstream(folder / "poses.csv")
        << "time_s,shoulder.qw,shoulder.qx,shoulder.qy,shoulder.qz,elbow.angle_rad\n"
           "0,1,0,0,0,0.3\n1,1,0,0,0,1.3\n2,1,0,0,0,1.3\n";
    reference::JointPlayer::Params params;
    params.place.file = folder / "joint_target.xml";
    params.file = "poses.csv";
    return {params, robot};
  }
  void place_elbow(double elbow_rad, double elbow_rad_per_s = 0) {
    Eigen::VectorXd variance_rad2 = Eigen::VectorXd::Zero(4);
    std::vector<sim::JointReading> now;
    for (const auto& joint : names.list()) now.push_back(sim::initial_reading(joint));
    now[1].position[0] = elbow_rad, now[1].velocity_rad_per_s[0] = elbow_rad_per_s;
    names.write(now, variance_rad2, sim::SkeletonModel(sim::RobotTree(robot), {0, 0, -9.81}),
                state.message);
    state.received = true;
    state.message.stamp_ns = frame.stamp_ns;
  }
  sim::JointMotion elbow(double dt_s) {
    frame.stamp_ns += static_cast<std::int64_t>(1e9 * dt_s);
    const auto target = player.step(frame, dt_s, state);
    REQUIRE(target);
    std::vector<sim::JointMotion> motions;
    REQUIRE(names.read(*target, motions));
    return motions[1];
  }
  /// Runs periods in which the robot is at the reference of the previous period.
  sim::JointMotion follow(int periods) {
    sim::JointMotion reference = elbow(0);
    for (int k = 0; k < periods; ++k) {
      place_elbow(reference.now.position[0], reference.now.velocity_rad_per_s[0]);
      reference = elbow(period_s);
    }
    return reference;
  }
};

}  // namespace

TEST_CASE(
    "the motion starts at the robot's position, reaches the first pose, then follows the path") {
  Fixture bench;
  bench.place_elbow(0.4);
  CHECK(bench.elbow(0).now.position[0] == Approx(0.4));
  CHECK(bench.follow(200).now.position[0] == Approx(0.3).margin(1e-3));  // 1.875 · 0.1/0.5 s
  CHECK(bench.follow(700).now.position[0] == Approx(1.3).margin(0.01));
}

TEST_CASE("after missing frames the motion resumes at the robot's position and velocity") {
  Fixture bench;
  bench.place_elbow(0.3);
  const auto before = bench.follow(350);
  REQUIRE(before.now.velocity_rad_per_s[0] > 1);
  bench.place_elbow(0.55, -0.4);  // the elbow fell without a command
  const auto after = bench.elbow(0.4);
  CHECK(after.now.velocity_rad_per_s[0] == Approx(-0.4));
  // A state of 0.4 s ago is not extrapolated.
  CHECK(after.now.position[0] == Approx(0.55));
  auto last = after;
  double largest_change_rad = 0;
  for (int k = 0; k < 1000; ++k) {
    const auto next = bench.follow(1);
    largest_change_rad =
        std::max(largest_change_rad, std::abs(next.now.position[0] - last.now.position[0]));
    last = next;
  }
  CHECK(largest_change_rad < 0.01);  // largest change between two periods: no jump
  CHECK(last.now.position[0] == Approx(1.3).margin(1e-6));
}

TEST_CASE("a state of the previous period is extrapolated to the frame's instant") {
  Fixture bench;
  bench.frame.stamp_ns = 10 * period_ns;
  bench.place_elbow(0.5, 2);
  std::vector<sim::JointReading> now;
  REQUIRE(bench.names.read(bench.state.message, bench.frame.stamp_ns + period_ns, now));
  CHECK(now[1].position[0] == Approx(0.504));
  REQUIRE(bench.names.read(bench.state.message, bench.frame.stamp_ns + 60'000'000, now));
  CHECK(now[1].position[0] == 0.5);  // not extrapolated beyond 50 ms
}
