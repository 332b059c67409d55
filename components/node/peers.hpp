#pragma once
#include <cstdint>
#include <optional>

#include "components/node/bus.hpp"
#include "components/node/peer.hpp"

namespace node {

/// The other participants on the bus.
class Peers {
 public:
  Peers(const Entity& participant, Wake& wake, Peer own);

  /// How many there are now, ourselves not counted.
  std::uint32_t count() const { return count_; }
  /// One that was here before us under our name and robot. Two of them would both drive.
  const std::optional<Peer>& predecessor() const { return predecessor_; }
  void look();

 private:
  Peer own_;
  Arrival arrival_;
  Entity reader_;
  std::uint32_t count_ = 0;
  std::optional<Peer> predecessor_;
};

}  // namespace node
