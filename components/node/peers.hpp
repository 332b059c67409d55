#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "components/node/bus.hpp"
#include "components/node/peer.hpp"

namespace node {

/// Time within which all participants on the machine are discovered; measured. It is longer with
/// DDS Security, which authenticates them first.
std::int64_t discovery_ns();

/// The other participants on the bus. With DDS Security only authenticated participants are listed,
/// because any process could announce itself as an active plant.
class Peers {
 public:
  Peers(const Entity& participant, Wake& wake, Peer self);

  /// Number of participants at the last `discover`, without this one.
  std::uint32_t count() const { return count_; }
  /// A peer with the same robot and the same name or role for which this process must end, because
  /// both would send commands.
  const std::optional<Peer>& running_duplicate() const { return running_duplicate_; }
  /// The same, for which this process does not end.
  const std::optional<Peer>& other_duplicate() const { return other_duplicate_; }
  /// Announces whether this process takes part in the control of the robot.
  void set_active(bool active);
  /// The peers in other processes that may be alive.
  const std::vector<Peer>& others() const { return others_; }
  /// Reads the current participants from DDS.
  void discover();

 private:
  void update_authenticated();
  bool is_authenticated(const dds_guid_t& participant) const;

  Peer self_;
  const Entity& participant_;
  DataCallback callback_;
  dds_guid_t own_key_{};
  Entity reader_;
  std::vector<Entity> endpoints_;  ///< readers of DDS's endpoint topics; empty without security
  std::vector<dds_guid_t> authenticated_;
  std::uint32_t count_ = 0;
  std::vector<Peer> others_;
  std::optional<Peer> running_duplicate_, other_duplicate_;
};

}  // namespace node
