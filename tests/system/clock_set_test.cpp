// The wall clock of all processes is set back and forward: commands of a stopped controller stay stale,
// rate limits hold, nothing counts as lost, and the recording shows the steps.
#include <sys/mman.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <regex>

#include "interfaces/recording/table.hpp"
#include "tests/stalls.hpp"
#include "tests/system/background.hpp"
#include "tests/system/recorded.hpp"

using namespace tests;

namespace {

constexpr double rate_N_per_s = 50;

/// The wall clock of the processes that are started while an object exists.
class SettableClock {
 public:
  explicit SettableClock(const std::string& file) {
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT, 0600);
    REQUIRE(ftruncate(descriptor, sizeof(std::int64_t)) == 0);
    void* mapped =
        mmap(nullptr, sizeof(std::int64_t), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    close(descriptor);
    REQUIRE(mapped != MAP_FAILED);
    shift_ns_ = static_cast<std::int64_t*>(mapped);
    setenv("ERP_CLOCK_SHIFT", file.c_str(), 1);
    setenv("LD_PRELOAD", ERP_SET_CLOCK, 1);
  }
  ~SettableClock() {
    unsetenv("LD_PRELOAD");
    munmap(shift_ns_, sizeof(std::int64_t));
  }
  void set_by(double s) { __atomic_fetch_add(shift_ns_, std::llround(1e9 * s), __ATOMIC_SEQ_CST); }

 private:
  std::int64_t* shift_ns_;
};

/// The hinge rig, whose flexor follows steps between 10 and 60 N within its rate limit.
std::string write_graph(const Folder& folder) {
  std::string robot = content(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml");
  const std::string limit = "max_tension_N=\"150\"";
  robot.insert(robot.find(limit), "max_tension_rate_N_per_s=\"" +
                                      std::to_string(static_cast<int>(rate_N_per_s)) + "\" ");
  std::ofstream(folder / "robot.xml") << robot;
  std::ofstream(folder / "steps.csv")
      << "time_s,flexor.mode,flexor.reference,extensor.mode,extensor.reference\n"
         "0,force,10,force,10\n1.5,force,10,force,10\n"
         "1.501,force,60,force,10\n3,force,60,force,10\n";
  std::ofstream(folder / "reference.xml") << "<reference file=\"steps.csv\" loop=\"true\"/>\n";
  std::ofstream(folder / "graph.xml")
      << "<graph name=\"steps\" robot=\"robot.xml\" device=\"sim\">\n"
         "  <component name=\"reference\" config=\"reference.xml\"/>\n"
         "  <component name=\"logger\"/>\n</graph>\n";
  return folder / "graph.xml";
}

/// Largest change of the flexor's reference per time between two rows, relative to its limit. The ECU
/// reports a reference up to 2 ms late.
double largest_rate_ratio(const recording::Table& table) {
  const auto& time_s = table.columns.front().values;
  const auto& reference_N = table.find("flexor.reference")->values;
  double largest = 0, previous_N = NAN, previous_s = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (std::isnan(reference_N[row])) continue;
    const double change_N = std::abs(reference_N[row] - previous_N);
    const double allowed_N = rate_N_per_s * (time_s[row] - previous_s + 0.01) + 0.5;
    if (previous_N > 5 && reference_N[row] > 5) largest = std::max(largest, change_N / allowed_N);
    previous_N = reference_N[row], previous_s = time_s[row];
  }
  return largest;
}

struct Rig {
  Folder folder;
  SettableClock clock{folder / "shift"};
  Background graph{{"launch", write_graph(folder), "--out", folder / "run"}, folder / "out.txt"};
  std::string recording() const { return folder / "run/steps.mcap"; }
  /// Actuators with an owner in the last actuator_owner message before the recording ended.
  int owned_at_end() const {
    const Recorded owners(recording(), "actuator_owner");
    int owned = 0;
    for (const auto& actuator : elements(owners.messages().back(), "actuators"))
      owned += !text(*actuator.members(), "owner").empty();
    return owned;
  }
  bool reports(const std::string& word) const {
    return graph.output().find(word) != std::string::npos;
  }
};

/// The steps of the clock that `erp log info` reports, in s; negative: set back.
std::vector<double> reported_steps_s(const std::string& recording) {
  const auto info = run("erp log info " + recording).output;
  const std::regex step("set (back|forward) by ([0-9.]+) s");
  std::vector<double> steps_s;
  for (std::sregex_iterator found(info.begin(), info.end(), step), end; found != end; ++found)
    steps_s.push_back(std::stod((*found)[2]) * ((*found)[1] == "back" ? -1 : 1));
  return steps_s;
}

}  // namespace

namespace {

constexpr double set_by_s[]{-5, 3, -2, 3, -5};

/// Runs the graph while its clock is set. Returns reports of losses, which a busy computer can also
/// cause.
Findings run_while_clock_is_set(Rig& rig) {
  REQUIRE(rig.graph.wait_for_output("all components are active"));
  std::this_thread::sleep_for(1s);
  for (const double step_s : set_by_s) {
    rig.clock.set_by(step_s);
    std::this_thread::sleep_for(700ms);  // rising, falling and constant references
  }
  CHECK(rig.graph.stop() == 0);
  Findings reported;
  for (const std::string word :
       {"lost", "no frame", "stale", "slack", "restart", "missing", "without an owner"})
    if (rig.reports(word)) reported.push_back("reported \"" + word + "\":\n" + rig.graph.output());
  return reported;
}

void check_recording(const Rig& rig) {
  const auto table = recording::read_table(rig.recording(), {});
  CHECK(largest_rate_ratio(table) < 1);
  const auto& time_s = table.columns.front().values;
  CHECK(std::ranges::is_sorted(time_s));
  CHECK(time_s.back() < 9);  // with the steps forward: more than 10 s
  const auto steps_s = reported_steps_s(rig.recording());
  REQUIRE(steps_s.size() == std::size(set_by_s));
  for (std::size_t k = 0; k < steps_s.size(); ++k)
    CHECK(steps_s[k] == Approx(set_by_s[k]).margin(0.05));
}

void check_replay(const Rig& rig) {
  const auto replayed =
      run("erp launch " + rig.folder / "graph.xml" + " --device replay:" + rig.recording() +
          " --lockstep --out " + rig.folder / "again");
  INFO(replayed.output);
  CHECK(replayed.exit_code == 0);
  CHECK(replayed.output.find("s after the first frame; the frames are played without this step") !=
        std::string::npos);
}

}  // namespace

TEST_CASE(
    "a running graph continues when the clock is set back by 5 s, by 2 s and forward by 3 s") {
  in_real_time([] {
    Rig rig;
    const Findings reported = run_while_clock_is_set(rig);
    if (!reported.empty()) return reported;
    CHECK(rig.owned_at_end() == 2);
    check_recording(rig);
    check_replay(rig);
    return reported;
  });
}

TEST_CASE("the command of a stopped controller stays stale when the clock is set") {
  for (const double step_s : {-5.0, -2.0, 3.0}) {
    INFO("clock set by " << step_s << " s");
    Rig rig;
    REQUIRE(rig.graph.wait_for_output("all components are active"));
    std::this_thread::sleep_for(1s);
    const pid_t controller = rig.graph.child("reference");
    REQUIRE(controller > 0);
    kill(controller, SIGSTOP);
    rig.clock.set_by(step_s);
    std::this_thread::sleep_for(1s);
    rig.clock.set_by(-step_s);  // a time service corrects it
    std::this_thread::sleep_for(1s);
    kill(rig.graph.child("logger"), SIGINT);  // the recording ends without the controller
    std::this_thread::sleep_for(300ms);
    kill(controller, SIGCONT);
    rig.graph.stop();
    INFO(rig.graph.output());
    const auto table = recording::read_table(rig.recording(), {});
    const auto& time_s = table.columns.front().values;
    const auto& reference_N = table.find("flexor.reference")->values;
    double largest_N = 0;
    for (std::size_t row = 0; row < table.rows(); ++row)
      if (time_s[row] > time_s.back() - 1.5 && !std::isnan(reference_N[row]))
        largest_N = std::max(largest_N, reference_N[row]);
    CHECK(largest_N < 6);  // the safe action relaxes to the pretension of 5 N
    CHECK(rig.owned_at_end() == 0);
  }
}

TEST_CASE("a graph starts while the clock is set") {
  Rig rig;
  for (const double step_s : {-5.0, 3.0, -2.0, 3.0}) {
    std::this_thread::sleep_for(150ms);
    rig.clock.set_by(step_s);
  }
  REQUIRE(rig.graph.wait_for_output("all components are active"));
  std::this_thread::sleep_for(1s);
  CHECK(rig.graph.stop() == 0);
  CHECK(rig.owned_at_end() == 2);
}
