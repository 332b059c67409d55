#pragma once
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "launch/erp/run/supervisor.hpp"

// Fixture of the supervisor tests: a graph without processes or clock.
using erp::Lifecycle;
using launch::Action;
using launch::Ending;
using launch::Phase;
using launch::Stage;
using Strings = std::vector<std::string>;
inline constexpr std::int64_t ms = 1'000'000, s = 1000 * ms;

/// A graph of three members: logger 0, plant 1, device 2.
struct Run {
  launch::Supervisor supervisor;
  std::int64_t now_ns = 1 * s;

  explicit Run(erp::Restart restart = erp::Restart::on_failure)
      : supervisor({{"logger", restart}, {"plant", restart}, {"sim", restart, true}}) {
    supervisor.start(now_ns);
  }

  /// The actions of the supervisor as "verb name", without printed text.
  Strings actions() {
    static const Strings names{"logger", "plant", "sim"};
    Strings list;
    for (const auto& action : supervisor.take_actions()) {
      const auto& name = names[action.member];
      if (action.kind == Action::Kind::spawn) list.push_back("spawn " + name);
      if (action.kind == Action::Kind::activate) list.push_back("activate " + name);
      if (action.kind == Action::Kind::terminate) list.push_back("terminate " + name);
      if (action.kind == Action::Kind::kill) list.push_back("kill " + name);
    }
    return list;
  }
  void wait(std::int64_t duration_ns) {
    now_ns += duration_ns;
    supervisor.tick(now_ns);
  }
  void heartbeat(std::size_t member, Lifecycle lifecycle, std::uint32_t peers = 3,
                 std::uint32_t links = 4) {
    supervisor.on_heartbeat(member, {lifecycle, peers, links}, now_ns);
  }
  void end(std::size_t member, Ending ending = {}) {
    supervisor.on_exit(member, ending, now_ns);
    supervisor.tick(now_ns);
  }
  void heartbeat_of_all(Lifecycle lifecycle) {
    for (std::size_t i = 0; i < 3; ++i) heartbeat(i, lifecycle);
  }
  /// Brings all members from spawned to active.
  void complete_start() {
    heartbeat_of_all(Lifecycle::inactive);
    wait(300 * ms);
    heartbeat_of_all(Lifecycle::active);
    wait(1 * ms);
    actions();
    REQUIRE(supervisor.stage() == Stage::running);
  }
};
