#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "components/node/bus.hpp"
#include "components/node/peer.hpp"

namespace node {

/// Within this time all who are on the machine are found: measured, and longer where they have to
/// prove who they are.
std::int64_t discovery_ns();

/// The other participants on the bus. Where it is protected, only those that have proved who they
/// are: anybody can say that he is the plant, and was here first.
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
  void hear_who_is_proved();
  bool is_proved(const dds_guid_t& participant) const;

  Peer own_;
  Arrival arrival_;
  dds_guid_t own_key_{};
  Entity reader_;
  std::vector<Entity> endpoints_;  ///< readers of DDS's topics of them; none on an open bus
  std::vector<dds_guid_t> proved_;
  std::uint32_t count_ = 0;
  std::vector<Peer> known_;
  std::optional<Peer> predecessor_;
};

}  // namespace node
