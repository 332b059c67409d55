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

/// The other participants on the bus. With DDS Security, only authenticated participants: any
/// process can announce itself as the plant with an earlier joining time.
class Peers {
 public:
  Peers(const Entity& participant, Wake& wake, Peer self);

  /// Number of participants at the last `discover`, without this one.
  std::uint32_t count() const { return count_; }
  /// A peer with our component name and robot that joined before us. Both would send commands.
  const std::optional<Peer>& earlier_duplicate() const { return earlier_duplicate_; }
  /// The peers in other processes that may be alive.
  const std::vector<Peer>& others() const { return others_; }
  /// Reads the current participants from DDS.
  void discover();

 private:
  void update_authenticated();
  bool is_authenticated(const dds_guid_t& participant) const;

  Peer self_;
  DataCallback callback_;
  dds_guid_t own_key_{};
  Entity reader_;
  std::vector<Entity> endpoints_;  ///< readers of DDS's endpoint topics; empty without security
  std::vector<dds_guid_t> authenticated_;
  std::uint32_t count_ = 0;
  std::vector<Peer> others_;
  std::optional<Peer> earlier_duplicate_;
};

}  // namespace node
