#include "sim/world/virtual_ecus.hpp"

#include "sim/model/effects/library.hpp"

namespace sim {

/// The robot with its effects separated, and the next sensor seed.
struct VirtualEcus::Setup {
  effects::Equipped equipped;
  VirtualEcuOptions options;
  std::uint64_t seed;
  Setup(const erp::Robot& nominal, const VirtualEcuOptions& o)
      : equipped(effects::equip(nominal)), options(o), seed(o.seed << 16) {}
};

VirtualEcus::VirtualEcus(const erp::Robot& nominal, const VirtualEcuOptions& options)
    : VirtualEcus(Setup(nominal, options)) {}

VirtualEcus::VirtualEcus(Setup&& setup)
    : converters_(setup.equipped.robot, setup.equipped.acting, setup.options.substeps, setup.seed),
      firmware_(converters_.channels().size()),
      voltage_V_(firmware_.size(), 0.0),
      bus_(effects::Acting(setup.equipped.acting, setup.equipped.robot.name, effects::Seat::robot),
           ++setup.seed) {
  for (ecu_channel& channel : firmware_) {
    ecu_init(&channel);
    ecu_set_zero(&channel, setup.options.zeros_known, 0);
    channel_pointers_.push_back(&channel);
  }
}

ecu_channel* VirtualEcus::find(int ecu, int number) {
  const auto channels = converters_.channels();
  for (std::size_t k = 0; k < channels.size(); ++k)
    if (channels[k].ecu == ecu && channels[k].number == number) return &firmware_[k];
  return nullptr;
}

void VirtualEcus::reset(int ecu) {
  const auto channels = converters_.channels();
  for (std::size_t k = 0; k < channels.size(); ++k) {
    if (channels[k].ecu != ecu) continue;
    ecu_init(&firmware_[k]);
    converters_.restart_encoder(k);
  }
}

void VirtualEcus::receive(const erp::EcuCommand& command) {
  if (bus_.empty()) apply(command);
  else bus_.send(command);
}

void VirtualEcus::apply(const erp::EcuCommand& command) {
  for (const erp::EcuChannelCommand& c : erp::samples(command.channels))
    if (ecu_channel* channel = find(c.ecu, c.channel))
      ecu_command(channel, static_cast<ecu_request>(c.request), c.setpoint);
}

void VirtualEcus::receive(const erp::EcuParameter& parameters) {
  for (const erp::EcuParameterValue& p : erp::samples(parameters.values))
    if (ecu_channel* channel = find(p.ecu, p.channel))
      ecu_parameter(channel, p.index, p.value, p.commit);
}

void VirtualEcus::measure(const World& world) {
  converters_.measure(world);
  send_measured(world.time_s());
}

void VirtualEcus::send_measured(double time_s) {
  measured_ = true;
  if (bus_.empty()) return;
  erp::EcuFrame frame;
  report(frame);
  bus_.send_frame(frame, time_s);
}

void VirtualEcus::tick(World& world) {
  if (!measured_) measure(world);
  while (const erp::EcuCommand* command = bus_.arrived(world.time_s())) apply(*command);
  const auto channels = converters_.channels();
  for (std::size_t k = 0; k < channels.size(); ++k)
    voltage_V_[k] =
        channels[k].supply_V * ecu_tick(&firmware_[k], &channels[k].inputs) / ECU_DUTY_MAX;
  converters_.pass_period(world, voltage_V_);
  send_measured(world.time_s());
}

void VirtualEcus::fill(erp::EcuFrame& frame) const {
  if (bus_.empty() || !measured_) return report(frame);
  const erp::EcuFrame& newest_frame = bus_.newest_frame();
  frame.channels._length = frame.analogs._length = 0;
  for (const auto& channel : erp::samples(newest_frame.channels))
    erp::append(frame.channels, channel);
  for (const auto& analog : erp::samples(newest_frame.analogs)) erp::append(frame.analogs, analog);
}

void VirtualEcus::report(erp::EcuFrame& frame) const {
  frame.channels._length = frame.analogs._length = 0;
  const auto channels = converters_.channels();
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const Converters::Channel& c = channels[k];
    const ecu_channel& f = firmware_[k];
    erp::append(
        frame.channels,
        erp::EcuChannelSample{
            static_cast<std::uint8_t>(c.ecu), static_cast<std::uint8_t>(c.number), measured_,
            static_cast<std::uint8_t>(f.state), static_cast<std::uint8_t>(f.fault),
            static_cast<std::uint8_t>(f.request), f.setpoint, f.zero_known,
            c.inputs.encoder_counts + f.zero_counts, f.duty, c.inputs.current_counts,
            c.inputs.tension_counts, static_cast<std::uint8_t>(f.accepted_commits & 7u),
            static_cast<std::uint8_t>(f.rejected_commits)});
  }
  for (const Converters::Analog& a : converters_.analogs())
    erp::append(frame.analogs,
                erp::EcuAnalogSample{static_cast<std::uint8_t>(a.ecu),
                                     static_cast<std::uint8_t>(a.input), measured_, a.counts});
}

}  // namespace sim
