// Names and entries that others send do not increase the memory of any process of a graph.
#include <catch2/catch.hpp>
#include <fstream>

#include "components/node/bus.hpp"
#include "components/node/clock.hpp"
#include "tests/system/background.hpp"

using namespace tests;

namespace {

constexpr int names = 50'000;
constexpr int messages_of_unknown_actuators = 1'000'000 / 64;
constexpr int burst = 20;  // messages between two pauses of 1 ms
constexpr long max_growth_kB = 2048;
constexpr long max_logger_growth_kB = 8192;  // its buffers grow with the rate of what it records

/// Resident memory of a process that belongs to no file.
long anonymous_kB(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; status >> word;)
    if (word == "RssAnon:") return status >> word, std::stol(word);
  return 0;
}

/// A participant that sends messages which no process of the graph needs.
class Stranger {
 public:
  template <class M, class Change>
  void send(int count, Change&& change) {
    node::Writer<M> writer(participant_);
    M message;
    erp::assign(message.robot, "hinge_rig");
    for (int i = 0; i < count; ++i) {
      message.stamp_ns = node::wall_ns();
      change(message, "stranger_" + std::to_string(i));
      writer.write(message);
      if (i % burst == 0) std::this_thread::sleep_for(1ms);
    }
  }

 private:
  node::Entity participant_ = node::join("stranger");
};

template <class M>
void name_controller(M& message, const std::string& name) {
  erp::assign(message.controller, name);
}
template <class M>
void name_component(M& message, const std::string& name) {
  erp::assign(message.component, name);
}
template <class M>
void name_robot(M& message, const std::string& name) {
  erp::assign(message.robot, name);
}

void name_actuators(erp::ActuatorCommand& message, const std::string& name) {
  message.actuators._length = 0;
  for (int i = 0; i < 64; ++i) {
    erp::ActuatorReference reference{};
    erp::assign(reference.name, name + "_" + std::to_string(i));
    erp::append(message.actuators, reference);
  }
}

std::uint64_t frames_in(std::chrono::milliseconds duration) {
  const node::Entity participant = node::join("listener");
  node::Wake wake;
  node::Reader<erp::SensorFrame> frames(participant, wake, 1000);
  std::this_thread::sleep_for(500ms);  // discovery
  frames.take([](const auto&) {});
  std::this_thread::sleep_for(duration);
  std::uint64_t count = 0;
  frames.take([&](const auto&) { ++count; });
  return count;
}

}  // namespace

TEST_CASE("names and entries that others send leave the memory of a graph as it is") {
  Folder folder;
  Background graph({"launch", "launch/idle.xml", "--out", folder / "run"}, folder / "run.txt");
  REQUIRE(graph.wait_for_output("all components are active"));
  std::this_thread::sleep_for(3s);  // until the recording and DDS have their buffers
  auto processes = graph.children();
  REQUIRE(processes.size() == 3);  // sim, plant, logger
  processes.push_back(graph.pid());
  const pid_t logger = graph.child("logger");
  std::vector<long> before_kB;
  for (const auto pid : processes) before_kB.push_back(anonymous_kB(pid));

  Stranger stranger;
  stranger.send<erp::ActuatorCommand>(names, name_controller<erp::ActuatorCommand>);
  stranger.send<erp::ActuatorCommand>(names, name_robot<erp::ActuatorCommand>);
  stranger.send<erp::GainCommand>(names, name_controller<erp::GainCommand>);
  stranger.send<erp::LifecycleCommand>(names, name_component<erp::LifecycleCommand>);
  stranger.send<erp::ComponentState>(names, name_component<erp::ComponentState>);
  stranger.send<erp::EcuFrame>(names, name_robot<erp::EcuFrame>);
  stranger.send<erp::ActuatorCommand>(messages_of_unknown_actuators, name_actuators);

  for (std::size_t i = 0; i < processes.size(); ++i) {
    const long after_kB = anonymous_kB(processes[i]);
    CAPTURE(processes[i], before_kB[i], after_kB);
    CHECK(after_kB > 0);
    CHECK(after_kB - before_kB[i] <=
          (processes[i] == logger ? max_logger_growth_kB : max_growth_kB));
  }
  CHECK(frames_in(500ms) > 100);  // the plant still sends frames
  CHECK(graph.stop() == 0);
}
