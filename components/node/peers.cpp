#include "components/node/peers.hpp"

#include <algorithm>
#include <cstring>

#include "components/node/builtin.hpp"
#include "components/node/security.hpp"

namespace node {
namespace {

constexpr std::int64_t unsecured_discovery_ns = 300'000'000;  // measured
constexpr std::int64_t secured_discovery_ns =
    1'000'000'000;  // measured: 0.3 … 0.6 s on a busy machine

bool same_guid(const dds_guid_t& a, const dds_guid_t& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

std::int64_t discovery_ns() {
  return security_folder().empty() ? unsecured_discovery_ns : secured_discovery_ns;
}

Peers::Peers(const Entity& participant, Wake& wake, Peer self)
    : self_(std::move(self)),
      participant_(participant),
      callback_(wake_callback(wake)),
      reader_(make_builtin_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, callback_)) {
  dds_get_guid(participant.id(), &own_key_);
  if (security_folder().empty()) return;
  for (const auto topic : {DDS_BUILTIN_TOPIC_DCPSPUBLICATION, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION})
    endpoints_.push_back(make_builtin_reader(participant, topic, callback_));
}

/// Participant announcements are not encrypted. Endpoints are announced only between participants
/// that have accepted each other's certificate, so a participant with a known endpoint is
/// authenticated. It stays authenticated: GUIDs are not reused.
void Peers::update_authenticated() {
  for (const auto& reader : endpoints_)
    for_each_alive<dds_builtintopic_endpoint_t>(
        reader,
        [&](const auto& endpoint, const auto&) {
          if (!is_authenticated(endpoint.participant_key))
            authenticated_.push_back(endpoint.participant_key);
        },
        unread_only);
}

bool Peers::is_authenticated(const dds_guid_t& participant) const {
  return std::ranges::any_of(authenticated_,
                             [&](const auto& key) { return same_guid(key, participant); });
}

void Peers::set_active(bool active) {
  if (self_.active == active) return;
  self_.active = active;
  announce(participant_, self_);
}

void Peers::discover() {
  update_authenticated();
  count_ = 0;
  running_duplicate_.reset();
  other_duplicate_.reset();
  others_.clear();
  for_each_alive<dds_builtintopic_participant_t>(reader_, [&](const auto& sample, const auto&) {
    if (same_guid(sample.key, own_key_)) return;
    if (!endpoints_.empty() && !is_authenticated(sample.key)) return;
    ++count_;
    const Peer peer = parse_peer(user_data(sample.qos));
    if (!may_be_alive(peer)) return;
    if (peer.pid != self_.pid || peer.host != self_.host) others_.push_back(peer);
    if (are_duplicates(peer, self_))
      (yields_to(self_, peer) ? running_duplicate_ : other_duplicate_) = peer;
  });
}

}  // namespace node
