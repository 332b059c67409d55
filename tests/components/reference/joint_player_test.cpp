#include "components/reference/joint_player.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/interfaces/recording/support.hpp"

namespace {

constexpr double period_s = 0.002;
constexpr std::int64_t period_ns = 2'000'000;

/// The arm's elbow led from 0.3 to 1.3 rad within a second, and an arm that stands where one puts it.
struct Led {
  test::Folder folder;
  erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/arm/robot.xml");
  joints::Names names{robot};
  reference::JointPlayer player = made();
  node::Latest<erp::JointState> state;
  erp::SensorFrame frame;

  reference::JointPlayer made() {
    std::ofstream(folder / "poses.csv")
        << "time_s,shoulder.qw,shoulder.qx,shoulder.qy,shoulder.qz,elbow.angle_rad\n"
           "0,1,0,0,0,0.3\n1,1,0,0,0,1.3\n2,1,0,0,0,1.3\n";
    reference::JointPlayer::Params params;
    params.place.file = folder / "joint_target.xml";
    params.file = "poses.csv";
    return {params, robot};
  }
  void stand(double elbow_rad, double elbow_rad_per_s = 0) {
    Eigen::VectorXd none = Eigen::VectorXd::Zero(4);
    std::vector<sim::JointReading> now;
    for (const auto& joint : names.list()) now.push_back(sim::start_of(joint));
    now[1].position[0] = elbow_rad, now[1].velocity_rad_per_s[0] = elbow_rad_per_s;
    names.write(now, none, sim::SkeletonModel(sim::RobotTree(robot), {0, 0, -9.81}), state.message);
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
  /// The robot follows: it is where it was led the period before.
  sim::JointMotion follow(int periods) {
    sim::JointMotion led = elbow(0);
    for (int k = 0; k < periods; ++k) {
      stand(led.now.position[0], led.now.velocity_rad_per_s[0]);
      led = elbow(period_s);
    }
    return led;
  }
};

}  // namespace

TEST_CASE("a way is led from where the robot is to its first pose, and then in its time") {
  Led led;
  led.stand(0.4);
  CHECK(led.elbow(0).now.position[0] == Approx(0.4));
  CHECK(led.follow(200).now.position[0] == Approx(0.3).margin(1e-3));  // 1.875 · 0.1/0.5 s
  CHECK(led.follow(700).now.position[0] == Approx(1.3).margin(0.01));
}

TEST_CASE("after missing frames the robot is led on from where it is, as it moves; the way waits") {
  Led led;
  led.stand(0.3);
  const auto before = led.follow(350);
  REQUIRE(before.now.velocity_rad_per_s[0] > 1);
  led.stand(0.55, -0.4);  // it fell while nobody drove it
  const auto after = led.elbow(0.4);
  CHECK(after.now.velocity_rad_per_s[0] == Approx(-0.4));
  // The state is of 0.4 s ago: too old to be brought to now.
  CHECK(after.now.position[0] == Approx(0.55));
  auto last = after;
  double longest_rad = 0;
  for (int k = 0; k < 1000; ++k) {
    const auto next = led.follow(1);
    longest_rad = std::max(longest_rad, std::abs(next.now.position[0] - last.now.position[0]));
    last = next;
  }
  CHECK(longest_rad < 0.01);  // of two periods: no jump
  CHECK(last.now.position[0] == Approx(1.3).margin(1e-6));
}

TEST_CASE("what was said of the period before is brought to the frame's instant, as it moves") {
  Led led;
  led.frame.stamp_ns = 10 * period_ns;
  led.stand(0.5, 2);
  std::vector<sim::JointReading> now;
  REQUIRE(led.names.read(led.state.message, led.frame.stamp_ns + period_ns, now));
  CHECK(now[1].position[0] == Approx(0.504));
  REQUIRE(led.names.read(led.state.message, led.frame.stamp_ns + 60'000'000, now));
  CHECK(now[1].position[0] == 0.5);  // clocks that differ
}
