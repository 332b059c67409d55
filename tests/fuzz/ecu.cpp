// Target: arbitrary frames, bundles and sensor readings as input of a complete ECU: link, states
// and laws of firmware/core.
#include <array>
#include <vector>

#include "firmware/board/board.h"
#include "firmware/core/bundle.h"
#include "tests/firmware/core/channel.hpp"
#include "tests/fuzz/frames.hpp"

namespace {

constexpr std::uint8_t address = 3;

class Ecu {
 public:
  /// Bits of `equipment_bits`: channels (2 bits), analog inputs (4 bits), gains loaded (1 bit).
  explicit Ecu(std::uint8_t equipment_bits) {
    const board_fitted equipment{address, static_cast<std::uint8_t>(equipment_bits & 3),
                                 static_cast<std::uint8_t>(equipment_bits >> 2 & 15), 0xC0FFEE};
    bus_frame boot;
    ecu_board_init(&board_, &equipment, FRAME_RESET_POWER, &boot);
    if (equipment_bits & 64)
      for (ecu_channel& channel : board_.channel) firmware::load(channel, firmware::fitted_gains());
  }

  void step(fuzz::Input& in) {
    switch (in.take<std::uint8_t>() % 4) {
      case 0:
        return receive(fuzz::take_frame(in));
      case 1:
        return receive_bundle(in);
      case 2:
        return period(in);
      default:
        check_sent(ecu_board_repeat(&board_, frames_.data()));
    }
  }

 private:
  void receive(const bus_frame& frame) { ecu_board_receive(&board_, &frame); }

  void receive_bundle(fuzz::Input& in) {
    const auto bundle = in.take<bus_bundle>();
    std::vector<bus_frame> frames(BUNDLE_FRAMES_MAX);
    const unsigned count = bundle_unpack(&bundle, frames.data());
    fuzz::require(count <= frames.size(), "a bundle holds at most six frames");
    for (unsigned i = 0; i < count; ++i) receive(frames[i]);
  }

  static ecu_inputs take_inputs(fuzz::Input& in) {
    ecu_inputs inputs{};
    inputs.encoder_counts = in.take<std::int32_t>();
    inputs.current_counts = in.take<std::int16_t>();
    inputs.tension_counts = in.take<std::uint16_t>();
    inputs.temperature_counts = in.take<std::uint16_t>();
    inputs.supply_counts = in.take<std::uint16_t>();
    return inputs;
  }

  void period(fuzz::Input& in) {
    board_period period_inputs{};
    const auto flags = in.take<std::uint8_t>();
    period_inputs.overran = flags & 1, period_inputs.bus_off = flags & 2;
    for (ecu_inputs& inputs : period_inputs.readings.channel) inputs = take_inputs(in);
    for (std::int32_t& counts : period_inputs.readings.analog) counts = in.take<std::int32_t>();
    std::array<std::int16_t, 2> duty{};
    for (int periods = 1 + (flags >> 2); periods > 0;
         --periods)  // some faults appear after many periods
      check_sent(ecu_board_period(&board_, &period_inputs, duty.data(), frames_.data()));
    for (int k = 0; k < 2; ++k) {
      fuzz::require(std::abs(duty[k]) <= ECU_DUTY_MAX, "a duty is within full supply");
      fuzz::require(duty[k] == 0 || board_.channel[k].state == ECU_STATE_RUNNING,
                    "PWM is 0 in every state but running");
    }
  }

  /// Checks that the sent frames are intact, and unchanged after packing into bundles.
  void check_sent(unsigned count) {
    fuzz::require(count <= frames_.size(), "an ECU sends at most eleven frames");
    for (unsigned i = 0; i < count; ++i)
      fuzz::require(frame_is_intact(&frames_[i]) && frame_ecu_of(&frames_[i]) == address,
                    "an ECU sends intact frames with its own address");
    for (unsigned packed_count = 0; packed_count < count;) {
      bus_bundle bundle;
      const unsigned bundle_size =
          bundle_pack(&bundle, &frames_[packed_count], count - packed_count);
      std::array<bus_frame, BUNDLE_FRAMES_MAX> unpacked_frames;
      fuzz::require(bundle_unpack(&bundle, unpacked_frames.data()) == bundle_size,
                    "all frames of a bundle are unpacked");
      for (unsigned i = 0; i < bundle_size; ++i)
        fuzz::require(
            unpacked_frames[i].id == frames_[packed_count + i].id &&
                std::memcmp(unpacked_frames[i].data, frames_[packed_count + i].data, 8) == 0,
            "a frame is unchanged by a bundle");
      packed_count += bundle_size;
    }
  }

  ecu_board board_{};
  std::vector<bus_frame> frames_ = std::vector<bus_frame>(ECU_LINK_FRAMES_MAX);
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input in(data, size);
  Ecu ecu(in.take<std::uint8_t>());
  while (!in.empty()) ecu.step(in);
  return 0;
}
