#include <csignal>

#include "tests/launch/erp/run/supervisor_run.hpp"

TEST_CASE("all processes are spawned at once") {
  Run run;
  CHECK(run.actions() == Strings{"spawn logger", "spawn plant", "spawn sim"});
}

TEST_CASE("components are activated in order, each when the one before is active") {
  Run run;
  run.actions();
  run.heartbeat_of_all(Lifecycle::inactive);
  run.wait(250 * ms);
  CHECK(run.actions() == Strings{"activate logger"});
  run.wait(10 * ms);
  CHECK(run.actions().empty());
  run.heartbeat(0, Lifecycle::active);
  run.wait(10 * ms);
  CHECK(run.actions() == Strings{"activate plant"});
  run.heartbeat(1, Lifecycle::active);
  run.wait(10 * ms);
  CHECK(run.actions() == Strings{"activate sim"});
  CHECK(run.supervisor.stage() == Stage::activating);
  run.heartbeat(2, Lifecycle::active);
  run.wait(10 * ms);
  CHECK(run.supervisor.stage() == Stage::running);
}

TEST_CASE("no component is activated while one has not discovered every other process") {
  Run run;
  run.actions();
  run.heartbeat_of_all(Lifecycle::inactive);
  run.heartbeat(1, Lifecycle::inactive, 2);
  run.wait(5 * s);
  CHECK(run.actions().empty());
  run.heartbeat(1, Lifecycle::inactive, 3);
  run.wait(1 * ms);
  CHECK(run.actions() == Strings{"activate logger"});
}

TEST_CASE("no component is activated while links change") {
  Run run;
  run.actions();
  run.heartbeat_of_all(Lifecycle::inactive);
  run.wait(150 * ms);
  run.heartbeat(2, Lifecycle::inactive, 3, 5);
  run.wait(150 * ms);
  CHECK(run.actions().empty());
  run.heartbeat(2, Lifecycle::inactive, 3, 5);
  run.wait(60 * ms);
  CHECK(run.actions() == Strings{"activate logger"});
}

TEST_CASE("an activation without effect is sent again after 200 ms") {
  Run run;
  run.actions();
  run.heartbeat_of_all(Lifecycle::inactive);
  run.wait(250 * ms);
  CHECK(run.actions() == Strings{"activate logger"});
  run.wait(200 * ms);
  CHECK(run.actions() == Strings{"activate logger"});
}

TEST_CASE("a start that exceeds its time limit stops and names the missing components") {
  Run run;
  run.actions();
  run.heartbeat(0, Lifecycle::inactive);
  run.wait(61 * s);
  std::string printed;
  for (const auto& action : run.supervisor.take_actions()) printed += action.text;
  CHECK(printed.find("not ready after 60.0 s: plant, sim") != printed.npos);
  CHECK(run.supervisor.stage() == Stage::stopping);
  CHECK(run.supervisor.exit_code() == 1);
}

TEST_CASE("a killed component is restarted after the back-off and activated when ready") {
  Run run;
  run.complete_start();
  run.end(1, {0, SIGKILL});
  run.wait(90 * ms);
  CHECK(run.actions().empty());
  CHECK(run.supervisor.phase(1) == Phase::backing_off);
  run.wait(20 * ms);
  CHECK(run.actions() == Strings{"spawn plant"});
  run.heartbeat(1, Lifecycle::inactive);
  run.wait(250 * ms);
  CHECK(run.actions() == Strings{"activate plant"});
  run.heartbeat(1, Lifecycle::active);
  CHECK(run.supervisor.phase(1) == Phase::active);
  CHECK(run.supervisor.restarts(1) == 1);
  CHECK(run.supervisor.stage() == Stage::running);
}

TEST_CASE(
    "the back-off doubles up to its maximum, and the sixth failure in the window ends the run") {
  Run run;
  run.complete_start();
  for (const std::int64_t delay_ns : {100 * ms, 200 * ms, 400 * ms, 800 * ms, 1600 * ms}) {
    run.end(1, {1, 0});
    run.wait(delay_ns - 1);
    CHECK(run.actions().empty());
    run.wait(1);
    CHECK(run.actions() == Strings{"spawn plant"});
  }
  run.end(1, {1, 0});
  CHECK(run.supervisor.phase(1) == Phase::failed);
  CHECK(run.supervisor.stage() == Stage::stopping);
  CHECK(run.supervisor.exit_code() == 1);
}

TEST_CASE("failures further apart than the window do not end the run") {
  Run run;
  run.complete_start();
  for (int i = 0; i < 20; ++i) {
    run.end(1, {1, 0});
    run.wait(100 * ms);
    CHECK(run.actions() == Strings{"spawn plant"});
    run.wait(31 * s);
  }
  CHECK(run.supervisor.stage() == Stage::running);
}

TEST_CASE("with restart=never a failure ends the run, exit code 0 does not") {
  Run failing(erp::Restart::never);
  failing.complete_start();
  failing.end(1, {1, 0});
  CHECK(failing.supervisor.stage() == Stage::stopping);
  CHECK(failing.supervisor.exit_code() == 1);

  Run ending(erp::Restart::never);
  ending.complete_start();
  ending.end(1);
  CHECK(ending.supervisor.stage() == Stage::running);
  CHECK(ending.supervisor.phase(1) == Phase::ended);
}

TEST_CASE("with restart=always a component is restarted after exit code 0") {
  Run run(erp::Restart::always);
  run.complete_start();
  run.end(1);
  CHECK(run.supervisor.phase(1) == Phase::backing_off);
}

TEST_CASE("a component that exits with 2 is not restarted, and the exit code of the run is 2") {
  Run run(erp::Restart::always);
  run.actions();
  run.end(1, {2, 0});
  CHECK(run.supervisor.phase(1) == Phase::failed);
  CHECK(run.supervisor.exit_code() == 2);
  CHECK(run.actions() == Strings{"terminate sim"});
}

TEST_CASE("a renewed graph ends all processes and starts them again in order") {
  Run run;
  run.complete_start();
  run.supervisor.renew(run.now_ns);
  CHECK(run.actions() == Strings{"terminate logger", "terminate plant", "terminate sim"});
  run.end(0);
  run.end(2);
  CHECK(run.actions() == Strings{"spawn logger", "spawn sim"});
  run.wait(600 * ms);
  CHECK(run.actions() == Strings{"kill plant"});
  run.end(1, {0, SIGKILL});
  CHECK(run.actions() == Strings{"spawn plant"});
  CHECK(run.supervisor.stage() == Stage::starting);
  run.complete_start();
  CHECK(run.supervisor.restarts(1) == 1);
  CHECK(run.supervisor.exit_code() == 0);
}

TEST_CASE("a graph can be renewed while it starts, and stopped while it is renewed") {
  Run run;
  run.complete_start();
  run.supervisor.renew(run.now_ns);
  for (std::size_t k : {0, 1, 2}) run.end(k);
  run.actions();
  run.supervisor.renew(run.now_ns);
  CHECK(run.actions() == Strings{"terminate logger", "terminate plant", "terminate sim"});
  run.supervisor.stop("enough", 0, run.now_ns);
  for (std::size_t k : {0, 1, 2}) run.end(k);
  CHECK(run.supervisor.done());
}
