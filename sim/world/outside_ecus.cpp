#include "sim/world/outside_ecus.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "firmware/core/ecu.h"
#include "sim/effects/library.hpp"

namespace sim {
namespace {

int listen_on(int port) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(static_cast<std::uint16_t>(port));
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (fd < 0 || ::bind(fd, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0) {
    const std::string why = std::strerror(errno);
    if (fd >= 0) ::close(fd);
    throw std::runtime_error("cannot listen for ECUs on port " + std::to_string(port) + ": " + why +
                             "; give another converter_port");
  }
  return fd;
}

wire_mishap_kind wire_kind_of(MishapKind kind) {
  if (kind == MishapKind::hang) return WIRE_MISHAP_HANG;
  return kind == MishapKind::busy ? WIRE_MISHAP_BUSY : WIRE_MISHAP_BUS_OFF;
}

}  // namespace

OutsideEcus::OutsideEcus(const erp::Robot& nominal, int port, std::uint64_t seed)
    : socket_(listen_on(port)) {
  const auto [robot, acting] = effects::equip(nominal);
  std::uint64_t from = seed << 16;
  converters_ = std::make_unique<Converters>(robot, acting, 1, from);
  voltage_V_.resize(converters_->channels().size());
  for (const int address : robot.ecus()) ecus_[address] = {};
}

OutsideEcus::~OutsideEcus() { ::close(socket_); }

void OutsideEcus::suffer(const Mishaps* mishaps) {
  mishaps_ = mishaps;
  converters_->suffer(mishaps);
}

// ---- from the ECUs ----

void OutsideEcus::hear() {
  std::array<std::uint8_t, 2048> datagram;
  sockaddr_in from{};
  socklen_t size = sizeof from;
  for (ssize_t n = 0; (n = ::recvfrom(socket_, datagram.data(), datagram.size(), 0,
                                      reinterpret_cast<sockaddr*>(&from), &size)) >= 0;)
    take(from, std::span(datagram).first(static_cast<std::size_t>(n)));
}

void OutsideEcus::take(const sockaddr_in& from, std::span<const std::uint8_t> bytes) {
  wire_reader& reader = open_[{from.sin_addr.s_addr, from.sin_port}];
  for (const std::uint8_t byte : bytes) {
    const wire_kind kind = wire_take(&reader, byte);
    if (kind != WIRE_DRIVE && kind != WIRE_SAMPLE) continue;
    const auto ecu = ecus_.find(wire_ecu(&reader));
    if (ecu == ecus_.end()) continue;
    ecu->second.where = from;
    ecu->second.silent = 0;
    if (kind == WIRE_DRIVE) wire_unpack_drive(&reader, ecu->second.duty.data());
    else answer(ecu->first, ecu->second);
  }
}

int OutsideEcus::alive() const {
  return static_cast<int>(std::ranges::count_if(
      ecus_, [](const auto& one) { return one.second.silent < silent_steps; }));
}

std::uint64_t OutsideEcus::unreadable() const {
  std::uint64_t sum = 0;
  for (const auto& [sender, reader] : open_) sum += reader.unreadable;
  return sum;
}

// ---- the robot ----

double OutsideEcus::voltage_V(const Converters::Channel& channel) const {
  const Ecu& ecu = ecus_.at(channel.ecu);
  if (ecu.silent >= silent_steps) return 0;
  const int duty = ecu.duty[static_cast<std::size_t>(channel.number)];
  return channel.supply_V * std::clamp(duty, -ECU_DUTY_MAX, ECU_DUTY_MAX) / ECU_DUTY_MAX;
}

void OutsideEcus::step(World& world) {
  const auto channels = converters_->channels();
  for (std::size_t k = 0; k < channels.size(); ++k) voltage_V_[k] = voltage_V(channels[k]);
  for (auto& [address, ecu] : ecus_) ecu.silent = std::min(ecu.silent + 1, silent_steps);
  if (mishaps_) send_mishaps(world.time_s());
  converters_->pass(world, voltage_V_, step_s);
}

void OutsideEcus::answer(int address, Ecu& to) {
  board_readings readings{};
  for (const Converters::Channel& c : converters_->channels())
    if (c.ecu == address) readings.channel[c.number] = c.inputs;
  for (const Converters::Analog& a : converters_->analogs())
    if (a.ecu == address) readings.analog[a.input] = a.counts;
  std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
  const unsigned size =
      wire_pack_readings(bytes.data(), static_cast<std::uint8_t>(address), &readings);
  send(to, std::span(bytes).first(size));
}

void OutsideEcus::send_mishaps(double time_s) {
  for (const Mishaps::OfEcu& one : mishaps_->of_ecus(time_s, step_s)) {
    const wire_mishap said{static_cast<std::uint8_t>(wire_kind_of(one.kind)),
                           static_cast<std::uint16_t>(one.periods)};
    std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
    const unsigned size = wire_pack_mishap(bytes.data(), static_cast<std::uint8_t>(one.ecu), &said);
    send(ecus_.at(one.ecu), std::span(bytes).first(size));
  }
}

/// To one that has spoken; who is not there yet hears the next.
void OutsideEcus::send(const Ecu& ecu, std::span<const std::uint8_t> bytes) {
  if (ecu.where.sin_port == 0) return;
  (void)::sendto(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                 reinterpret_cast<const sockaddr*>(&ecu.where), sizeof ecu.where);
}

}  // namespace sim
