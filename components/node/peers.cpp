#include "components/node/peers.hpp"

#include "components/node/builtin.hpp"

namespace node {

Peers::Peers(const Entity& participant, Wake& wake, Peer own)
    : own_(std::move(own)),
      arrival_(waking(wake)),
      reader_(make_builtin_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, arrival_)) {}

void Peers::look() {
  std::uint32_t seen = 0;
  predecessor_.reset();
  known_.clear();
  for_each_alive<dds_builtintopic_participant_t>(reader_, [&](const auto& sample, const auto&) {
    ++seen;
    const Peer peer = parse_peer(user_data(sample.qos));
    if (!may_be_alive(peer)) return;
    if (peer.pid != own_.pid || peer.host != own_.host) known_.push_back(peer);
    if (namesakes(peer, own_) && joined_before(peer, own_)) predecessor_ = peer;
  });
  count_ = seen > 0 ? seen - 1 : 0;
}

}  // namespace node
