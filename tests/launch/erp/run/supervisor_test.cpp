#include <csignal>

#include "tests/launch/erp/run/supervisor_run.hpp"

TEST_CASE("all processes are spawned at once") {
  Run run;
  CHECK(run.wanted() == Strings{"spawn logger", "spawn plant", "spawn sim"});
}

TEST_CASE("components are activated in order, each after the one before is active") {
  Run run;
  run.wanted();
  run.all(Lifecycle::inactive);
  run.wait(250 * ms);
  CHECK(run.wanted() == Strings{"activate logger"});
  run.wait(10 * ms);
  CHECK(run.wanted().empty());
  run.hear(0, Lifecycle::active);
  run.wait(10 * ms);
  CHECK(run.wanted() == Strings{"activate plant"});
  run.hear(1, Lifecycle::active);
  run.wait(10 * ms);
  CHECK(run.wanted() == Strings{"activate sim"});
  CHECK(run.supervisor.stage() == Stage::activating);
  run.hear(2, Lifecycle::active);
  run.wait(10 * ms);
  CHECK(run.supervisor.stage() == Stage::running);
}

TEST_CASE("nothing is activated while a component does not see every other process") {
  Run run;
  run.wanted();
  run.all(Lifecycle::inactive);
  run.hear(1, Lifecycle::inactive, 2);
  run.wait(5 * s);
  CHECK(run.wanted().empty());
  run.hear(1, Lifecycle::inactive, 3);
  run.wait(1 * ms);
  CHECK(run.wanted() == Strings{"activate logger"});
}

TEST_CASE("nothing is activated while links are still being made") {
  Run run;
  run.wanted();
  run.all(Lifecycle::inactive);
  run.wait(150 * ms);
  run.hear(2, Lifecycle::inactive, 3, 5);
  run.wait(150 * ms);
  CHECK(run.wanted().empty());
  run.hear(2, Lifecycle::inactive, 3, 5);
  run.wait(60 * ms);
  CHECK(run.wanted() == Strings{"activate logger"});
}

TEST_CASE("an activation that was not followed is sent again") {
  Run run;
  run.wanted();
  run.all(Lifecycle::inactive);
  run.wait(250 * ms);
  CHECK(run.wanted() == Strings{"activate logger"});
  run.wait(200 * ms);
  CHECK(run.wanted() == Strings{"activate logger"});
}

TEST_CASE("a start that does not come about is given up, and names who is missing") {
  Run run;
  run.wanted();
  run.hear(0, Lifecycle::inactive);
  run.wait(61 * s);
  std::string said;
  for (const auto& action : run.supervisor.take_actions()) said += action.text;
  CHECK(said.find("not ready after 60.0 s: plant, sim") != said.npos);
  CHECK(run.supervisor.stage() == Stage::stopping);
  CHECK(run.supervisor.exit_code() == 1);
}

TEST_CASE("a killed component is started again after a back-off and activated when ready") {
  Run run;
  run.get_running();
  run.end(1, {0, SIGKILL});
  run.wait(90 * ms);
  CHECK(run.wanted().empty());
  CHECK(run.supervisor.phase(1) == Phase::backing_off);
  run.wait(20 * ms);
  CHECK(run.wanted() == Strings{"spawn plant"});
  run.hear(1, Lifecycle::inactive);
  run.wait(250 * ms);
  CHECK(run.wanted() == Strings{"activate plant"});
  run.hear(1, Lifecycle::active);
  CHECK(run.supervisor.phase(1) == Phase::active);
  CHECK(run.supervisor.restarts(1) == 1);
  CHECK(run.supervisor.stage() == Stage::running);
}

TEST_CASE(
    "the back-off doubles up to its longest, and the sixth failure in the window ends the run") {
  Run run;
  run.get_running();
  for (const std::int64_t delay_ns : {100 * ms, 200 * ms, 400 * ms, 800 * ms, 1600 * ms}) {
    run.end(1, {1, 0});
    run.wait(delay_ns - 1);
    CHECK(run.wanted().empty());
    run.wait(1);
    CHECK(run.wanted() == Strings{"spawn plant"});
  }
  run.end(1, {1, 0});
  CHECK(run.supervisor.phase(1) == Phase::failed);
  CHECK(run.supervisor.stage() == Stage::stopping);
  CHECK(run.supervisor.exit_code() == 1);
}

TEST_CASE("failures far apart never end the run") {
  Run run;
  run.get_running();
  for (int i = 0; i < 20; ++i) {
    run.end(1, {1, 0});
    run.wait(100 * ms);
    CHECK(run.wanted() == Strings{"spawn plant"});
    run.wait(31 * s);
  }
  CHECK(run.supervisor.stage() == Stage::running);
}

TEST_CASE("restart=never: a failure ends the run, a clean exit does not") {
  Run failing(erp::Restart::never);
  failing.get_running();
  failing.end(1, {1, 0});
  CHECK(failing.supervisor.stage() == Stage::stopping);
  CHECK(failing.supervisor.exit_code() == 1);

  Run ending(erp::Restart::never);
  ending.get_running();
  ending.end(1);
  CHECK(ending.supervisor.stage() == Stage::running);
  CHECK(ending.supervisor.phase(1) == Phase::ended);
}

TEST_CASE("restart=always: even a clean exit is started again") {
  Run run(erp::Restart::always);
  run.get_running();
  run.end(1);
  CHECK(run.supervisor.phase(1) == Phase::backing_off);
}

TEST_CASE("a component that cannot use its input is not started again; the exit code says so") {
  Run run(erp::Restart::always);
  run.wanted();
  run.end(1, {2, 0});
  CHECK(run.supervisor.phase(1) == Phase::failed);
  CHECK(run.supervisor.exit_code() == 2);
  CHECK(run.wanted() == Strings{"terminate sim"});
}
