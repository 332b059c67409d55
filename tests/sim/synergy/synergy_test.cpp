#include <catch2/catch.hpp>

#include "sim/learner/dice.hpp"
#include "sim/synergy/bank_file.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::synergy;
using Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

namespace {

/// Five muscles lead the hand to `lead · w`.
const MatrixXd lead =
    (MatrixXd(3, 5) << 1, 0, 0, 0.5, 0, 0, 1, 0, 0, 0.5, 0, 0, 1, 0.2, 0.2).finished();

MotorPlan plan_of(const VectorXd& weights, double value = 1) {
  return {weights, {}, lead * weights, value};
}

/// All to one side of the origin.
Bank bank(int count) {
  auto dice = sim::learner::dice(5);
  std::uniform_real_distribution<double> any(0, 0.1);
  std::vector<MotorPlan> plans;
  for (int k = 0; k < count; ++k)
    plans.push_back(plan_of(VectorXd::NullaryExpr(5, [&] { return any(dice); })));
  return {{}, plans};
}

HandPath along(const Vector3d& way_m, double time_s, double wait_s) {
  HandPath path;
  for (double t = 0; t <= time_s + wait_s; t += path.sample_s)
    path.at_m.push_back(sim::least_jerk(t / time_s).done * way_m);
  return path;
}

}  // namespace

TEST_CASE("a blend leads to its target, though the plans near it lie to one side") {
  const Bank stored = bank(60);
  for (const Vector3d& target : {Vector3d(0.08, 0.07, 0.09), Vector3d(0.03, 0.03, 0.03)}) {
    const Blend blend = stored.blend(target);
    CHECK((lead * blend.plan.weights_m - target).norm() < 0.008);
    double sum = 0;
    for (const double credit : blend.credits) sum += credit;
    CHECK(sum == Approx(1));
  }
  CHECK(stored.blend({9, 9, 9}).plan.weights_m.allFinite());
  CHECK_THROWS_WITH(Bank().blend({0, 0, 0}), Catch::Contains("without plans"));
}

TEST_CASE("rewards are credited to those that contributed, and the valuable ones contribute more") {
  Bank two({.rate = 0.5},
           {plan_of(VectorXd::Constant(5, 0.1)), plan_of(VectorXd::Constant(5, 0.2))});
  const Vector3d between = lead * VectorXd::Constant(5, 0.15);
  CHECK(two.blend(between).credits[0] == Approx(0.5));
  two.credit({1, 0}, 0);
  CHECK(two.plans()[0].value == Approx(0.5));
  CHECK(two.plans()[1].value == 1);
  CHECK(two.blend(between).credits[0] == Approx(0.2));
  two.credit({1, 1}, 1.5), two.credit({1, 0}, -1000);  // worth nothing at all
  CHECK(two.blend(between).plan.weights_m.allFinite());
}

TEST_CASE("of too many plans those go that lead where a better one does") {
  std::vector<MotorPlan> plans{plan_of(VectorXd::Constant(5, 0.1), 1.2),
                               plan_of(VectorXd::Constant(5, 0.101), 0.9),
                               plan_of(VectorXd::Constant(5, 0.3), 0.1)};
  Bank stored({.most = 2}, plans);
  stored.trim();
  REQUIRE(stored.plans().size() == 2);
  CHECK(stored.plans()[0].value == 1.2);
  CHECK(stored.plans()[1].value == 0.1);  // the only one that leads there
  stored.cut(0);
  CHECK(stored.plans().size() == 1);
  CHECK(components(bank(60), 1.0) == 5);
  CHECK(components(Bank({}, {plans[0], plans[2]}), 0.99) == 1);
}

TEST_CASE("a plan varied is near the plan, and within bounds") {
  auto dice = sim::learner::dice(1);
  const MotorPlan plan = plan_of(VectorXd::Constant(5, 0.05));
  const MotorPlan other = varied(plan, {}, dice);
  CHECK(other.weights_m != plan.weights_m);
  CHECK((other.weights_m - plan.weights_m).cwiseAbs().maxCoeff() < 0.03);
  const MotorPlan wild =
      varied(plan, {.weights = 0, .weights_m = 0, .rise = 50, .beyond = 50}, dice);
  CHECK(wild.weights_m == plan.weights_m);
  CHECK((wild.signal.rise_s == 0.3 || wild.signal.rise_s == 1.6));
  CHECK(std::abs(wild.signal.beyond) == 0.4);
}

TEST_CASE("a trial leads lines back, plays its signal, and noise is in proportion to it") {
  const MotorPlan plan{VectorXd::Constant(2, 0.04), {.rise_s = 0.8, .beyond = 0.25}, {0, 0, 0}};
  Trial quiet(plan, {.way_s = 1, .still_s = 0.5, .watch_s = 1}, 0, 1);
  Trial noisy(plan, {.way_s = 1, .still_s = 0.5, .watch_s = 1}, 0.1, 1);
  double most = 0, squares = 0;
  int count = 0;
  for (double t = 3; !quiet.done(); t += 0.002) {
    const VectorXd line = quiet.step(t, Eigen::Vector2d(0.02, -0.02));
    const VectorXd with = noisy.step(t, Eigen::Vector2d(0.02, -0.02));
    quiet.see(t, Vector3d(t, 0, 0));
    CHECK(quiet.planned(t) == (t - 3 >= 1.5));
    if (t == 3) CHECK((line - Eigen::Vector2d(0.02, -0.02)).norm() == 0);
    if (t > 4.01 && t < 4.5) CHECK(line.norm() + with.norm() < 1e-12);  // no signal, no noise
    if (t > 4.6) most = std::max(most, -line[0]);
    if (t > 6) squares += (with - line).squaredNorm() / 2, ++count;
    if (t > 6) CHECK(line[0] == Approx(-0.04));
  }
  CHECK(most == Approx(0.05).epsilon(0.01));
  CHECK(std::sqrt(squares / count) == Approx(0.1 * 0.04).epsilon(0.5));
  CHECK(quiet.end_s() == Approx(1.2));
  CHECK(quiet.path().at_m.front().x() == Approx(4.5).margin(0.003));
  CHECK(quiet.path().at_m.size() == Approx(220).margin(2));
}

TEST_CASE("striking is touching; staying in the zone is rewarded beside") {
  const BottleConfig bottle;  // touched at 0.0725 m
  const HandPath path = along({0.3, 0, 0}, 1, 1);
  const Outcome there = judge(bottle, {0.3, 0, 0}, path, 1);
  CHECK(there.struck);
  CHECK(there.strike_s == Approx(0.66).margin(0.03));
  CHECK(there.strike_speed_m_per_s == Approx(0.47).margin(0.05));
  CHECK(there.stayed == 1);
  CHECK(there.reward == Approx(1.5));
  const Outcome past = judge(bottle, {0.15, 0, 0}, path, 1);
  CHECK(past.struck);
  CHECK(past.reward == Approx(1));  // it passed by
  const Outcome beside = judge(bottle, {0.3, 0.1, 0}, path, 1);
  CHECK(!beside.struck);
  CHECK(beside.nearest_m == Approx(0.0275).margin(1e-6));
  CHECK(beside.reward == Approx(0.5));
  CHECK(judge(bottle, {0.3, 0, 0.13}, path, 1).struck);  // at its foot
  CHECK(!judge(bottle, {0.3, 0, 0.15}, path, 1).struck);
  CHECK(!judge(bottle, {0, 0, 0}, {}, 1).struck);
}

TEST_CASE("the path with the least jerk has a relative jerk of one, and another one more") {
  const HandPath least = along({0.2, 0.1, -0.3}, 2, 0);
  CHECK(relative_jerk(least, 2) == Approx(1).epsilon(0.25));
  HandPath swung = least;
  for (std::size_t k = 0; k < swung.at_m.size(); ++k)
    swung.at_m[k].y() += 0.02 * std::sin(0.1 * double(k));
  CHECK(relative_jerk(swung, 2) > 5);
  CHECK((rest_of(along({1, 2, 3}, 1, 0.5)) - Vector3d(1, 2, 3)).norm() < 1e-9);
}

TEST_CASE(
    "a plan is stored where it led, and trusted the less the farther that is from its target") {
  const MotorPlan plan{VectorXd::Constant(2, 0.04), {.rise_s = 0.8, .beyond = 0}, {0, 0, 0}};
  Trial trial(plan, {.way_s = 0, .still_s = 0, .watch_s = 1}, 0, 1);
  for (double t = 0; !trial.done(); t += 0.002) {
    trial.step(t, VectorXd::Zero(2));
    trial.see(t, Vector3d(0.3 * sim::least_jerk(t / 0.8).done, 0, 0));
  }
  const BottleConfig bottle;
  const MotorPlan there = as_it_led(trial, bottle, {0.3, 0, 0});
  CHECK((there.at_m - Vector3d(0.3, 0, 0)).norm() < 1e-9);
  CHECK(there.weights_m == plan.weights_m);
  CHECK(there.value == Approx(1.5));
  const MotorPlan beside = as_it_led(trial, bottle, {0.3, 0.06, 0});
  CHECK(beside.at_m == there.at_m);
  CHECK(beside.value == Approx(1.5 * std::exp(-0.5)));
}

TEST_CASE("a bank is written and read again; what does not fit is told with its place") {
  BankFile file;
  file.hand.body = "hand";
  file.muscles.all = {{{}, "right_biceps"}};
  file.plans.all = {{{}, {0.1, 0.2, 0.3}, 1.25, 0.7, 0.1, {0.02}}};
  const auto again = xml::parse<BankFile>(xml::write(file), "bank.xml");
  CHECK_NOTHROW(check(again));
  CHECK(rows_of(bank_of(again)).front().value == 1.25);
  CHECK(bank_of(again).plans().front().signal.beyond == 0.1);
  BankFile wrong = again;
  wrong.plans.all.front().weights_m = {1, 2};
  CHECK_THROWS_WITH(check(wrong), Catch::Contains("2 weights, but there are 1 <learnt> muscles"));
  wrong.plans.all.clear();
  CHECK_THROWS_WITH(check(wrong), Catch::Contains("<plan>"));
  CHECK_THROWS_WITH(actuators_of({{{}, "no_such"}}, erp::read_robot(rigs::config("arm/robot.xml"))),
                    Catch::Contains("no_such"));
}
