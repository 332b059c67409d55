#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "components/node/bus.hpp"
#include "components/node/peer.hpp"

namespace node {

/// Measured: within this time all who are on the machine are found.
inline constexpr std::int64_t discovery_ns = 300'000'000;

/// The other participants on the bus.
class Peers {
 public:
  Peers(const Entity& participant, Wake& wake, Peer own);

  /// How many there are now, ourselves not counted.
  std::uint32_t count() const { return count_; }
  /// One that was here before us under our name and robot. Two of them would both drive.
  const std::optional<Peer>& predecessor() const { return predecessor_; }
  /// Those of them that say who they are, and whose process may be alive.
  const std::vector<Peer>& known() const { return known_; }
  void look();

 private:
  Peer own_;
  Arrival arrival_;
  Entity reader_;
  std::uint32_t count_ = 0;
  std::vector<Peer> known_;
  std::optional<Peer> predecessor_;
};

}  // namespace node
