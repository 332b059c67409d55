#include "launch/erp/learn/calibrate.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "interfaces/recording/csv.hpp"
#include "tests/sim/learning/calibration/arm_poses.hpp"

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator(in), {}};
}

/// A folder with a recording of the arm at rest. The calibration writes its results into it.
struct CalibrationFolder {
  fs::path path = fs::temp_directory_path() / "erp_calibrate_test";
  std::ostringstream out, remarks;

  CalibrationFolder() {
    fs::remove_all(path);
    fs::create_directories(path);
    const auto arm = arm_poses::arm();
    std::ofstream csv(path / "still.csv");
    recording::write_csv(arm_poses::recorded(arm, arm_poses::held_poses(arm, 8)), csv);
  }
  ~CalibrationFolder() { fs::remove_all(path); }

  std::string file(const char* name) const { return (path / name).string(); }
  launch::PoseFiles poses() const { return {{file("still.csv")}, {}}; }
  void perturb() {
    launch::calibrate_perturb({.robot = rigs::config("arm/robot.xml"),
                               .choice = rigs::config("arm/calibration.xml"),
                               .out = file("perturbed.xml"),
                               .poses = poses(),
                               .pose_errors_deg = {{"shoulder", 20}, {"elbow", 15}},
                               .seed = 2},
                              out);
  }
  launch::CalibrateOptions options(const char* folder, int rounds) const {
    return {.robot = file("perturbed.xml"),
            .choice = rigs::config("arm/calibration.xml"),
            .poses = poses(),
            .fit = {},
            .training = {.folder = file(folder), .rounds = rounds}};
  }
};

}  // namespace

TEST_CASE(
    "calibration reduces the error of a perturbed model below a tenth, and writes a valid robot") {
  CalibrationFolder fixture;
  fixture.perturb();
  CHECK_THAT(fixture.out.str(), Catch::Contains("perturbed"));
  auto options = fixture.options("found", 40);
  options.fit.strategy = sim::calibration::Strategy::newton;
  REQUIRE(launch::calibrate_run(options, fixture.out, fixture.remarks) == 0);
  CHECK_THAT(fixture.out.str(),
             Catch::Contains("identified") && Catch::Contains("shoulder, checked"));
  CHECK(text_of(fixture.path / "found/parameters.csv")
            .starts_with("parameter,changed,unit,remaining_uncertainty\n"));
  CHECK(fs::file_size(fixture.path / "found/curve.svg") > 1000);

  const auto errors = [&](const std::string& robot) {
    const auto poses = fixture.poses();
    const auto arm = erp::read_robot(robot);
    const sim::calibration::Parameters none(arm, {});
    return pose_errors(none.start(), sim::calibration::still_poses(
                                         recording::read_table(poses.learn.front()), arm))
        .mean_of_all_rad;
  };
  CHECK(errors(fixture.file("found/robot.xml")) < 0.1 * errors(fixture.file("perturbed.xml")));
}

TEST_CASE("an interrupted calibration prints how to continue, and resumes to the same robot") {
  CalibrationFolder fixture;
  fixture.perturb();
  REQUIRE(launch::calibrate_run(fixture.options("uninterrupted", 3), fixture.out,
                                fixture.remarks) == 0);
  auto options = fixture.options("resumed", 3);
  options.training.interrupted = [] { return true; };
  CHECK(launch::calibrate_run(options, fixture.out, fixture.remarks) == 1);
  CHECK_THAT(fixture.remarks.str(),
             Catch::Contains("after round 1 of 3") && Catch::Contains("--resume"));
  options.training.interrupted = [] { return false; };
  options.training.resume = true;
  CHECK(launch::calibrate_run(options, fixture.out, fixture.remarks) == 0);
  for (const char* file : {"robot.xml", "curve.csv", "state.xml"})
    CHECK(text_of(fixture.path / "resumed" / file) ==
          text_of(fixture.path / "uninterrupted" / file));
}

TEST_CASE("two processes under mpirun give the same result as one process") {
  CalibrationFolder fixture;
  fixture.perturb();
  REQUIRE(launch::calibrate_run(fixture.options("one", 3), fixture.out, fixture.remarks) == 0);
  const std::string run =
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout 60 mpirun --oversubscribe "
      "-n 2 " ERP_BIN_DIR "/erp calibrate run --robot " +
      fixture.file("perturbed.xml") + " --vary " + rigs::config("arm/calibration.xml") +
      " --real " + fixture.file("still.csv") + " --generations 3 --threads 1 --out " +
      fixture.file("two") + " > " + fixture.file("output") + " 2>&1";
  const int code = std::system(run.c_str());
  INFO(text_of(fixture.path / "output"));
  REQUIRE(code == 0);
  CHECK(text_of(fixture.path / "two/state.xml") == text_of(fixture.path / "one/state.xml"));
  CHECK(text_of(fixture.path / "two/robot.xml") == text_of(fixture.path / "one/robot.xml"));
  const std::string output = text_of(fixture.path / "output");
  CHECK(output.find("identified") ==
        output.rfind("identified: "));  // only the first process prints
}

TEST_CASE("an unknown joint and a recording without rest are rejected by name") {
  CalibrationFolder fixture;
  CHECK_THROWS_WITH(launch::calibrate_perturb({.robot = rigs::config("arm/robot.xml"),
                                               .choice = rigs::config("arm/calibration.xml"),
                                               .out = fixture.file("perturbed.xml"),
                                               .poses = fixture.poses(),
                                               .pose_errors_deg = {{"knee", 20}}},
                                              fixture.out),
                    Catch::Contains("no joint \"knee\""));
  auto moving = recording::read_table(fixture.file("still.csv"));
  for (std::size_t k = 0; k < moving.rows(); ++k)
    moving.columns.back().values[k] = 0.1 + 0.01 * double(k);
  std::ofstream(fixture.path / "moving.csv") << [&] {
    std::ostringstream text;
    recording::write_csv(moving, text);
    return text.str();
  }();
  CHECK_THROWS_WITH(launch::calibrate_check(rigs::config("arm/robot.xml"),
                                            {{fixture.file("moving.csv")}, {}}, fixture.out),
                    Catch::Contains("moving.csv") && Catch::Contains("never at rest"));
}

TEST_CASE("a tour holds each pose and the midway poses for the given time") {
  std::ostringstream out;
  REQUIRE(launch::calibrate_tour({rigs::config("arm/lengths.csv"), 3, 1}, out) == 0);
  const auto tour = recording::parse_csv("tour", out.str());
  REQUIRE(tour.rows() == 1 + 2 * 30);
  const auto& biceps = tour.find("biceps.reference")->values;
  CHECK(biceps[3] == Approx((biceps[1] + biceps[5]) / 2).margin(1e-9));
  CHECK(biceps[1] == biceps[2]);
  const auto& time_s = tour.find("time_s")->values;
  CHECK(time_s[2] - time_s[1] == Approx(3));
  CHECK(time_s[3] - time_s[2] == Approx(1));
}
