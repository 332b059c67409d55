#include "sim/learning/simulated_training/sensorimotor_training.hpp"

#include <catch2/catch.hpp>

#include "interfaces/xml/xml.hpp"
#include "tests/sim/learning/simulated_training/training_runs.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::simulated_training;

namespace {

/// The pendulum with a few goals.
SensorimotorTraining sensorimotor_training() {
  auto experiment =
      xml::read<sim::sensorimotor::Experiment>(rigs::config("pendulum/sensorimotor.xml"));
  experiment.grids.front().columns = experiment.grids.front().rows = 2;
  experiment.session.trials = 5, experiment.session.twitches = 16;
  return {erp::read_robot(rigs::config("pendulum/robot.xml")),
          xml::read<sim::cameras::ViewConfig>(rigs::config("pendulum/view.xml")), experiment};
}

}  // namespace

TEST_CASE(
    "the pendulum's Q has the signs of the paper's figure 9b, and errors fall below 60 % in 5 "
    "trials") {
  const auto trained = training_runs::run_in_three_ways("sensorimotor", sensorimotor_training);
  CHECK(trained.rounds() == 6);
  const Eigen::MatrixXd q = trained.learned().q();
  const Eigen::MatrixXd signs = (Eigen::MatrixXd(2, 4) << 1, 1, -1, -1, -1, 1, 1, -1).finished();
  CHECK(q.cwiseProduct(signs).minCoeff() > 0.1);
  for (const auto& goal : trained.goals()) {
    CHECK(goal.errors.front() == Approx(0.2 * std::sqrt(2)).epsilon(0.02));
    CHECK(goal.errors.back() < 0.6 * goal.errors.front());
  }
}
