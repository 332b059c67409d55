// Target: arbitrary frames from the bus and arbitrary messages from the plant, as input
// of the gateway of hal/can.
#include "hal/can/gateway.hpp"

#include "tests/fuzz/frames.hpp"
#include "tests/hal/can/rig.hpp"

namespace {

/// Two ECUs, three channels, two analog inputs.
const erp::Robot robot = can_test::robot_of(3);

class Bus {
 public:
  void step(fuzz::Input& in) {
    switch (in.take<std::uint8_t>() % 8) {
      case 0:
        return command(in);
      case 1:
        return parameter(in);
      case 2:
        return gateway_.close_tick();
      case 3:
        return gateway_.clear_events();
      default:
        return receive(fuzz::take_frame(in));
    }
  }

  void check() {
    fuzz::require(gateway_.frame().channels._length == robot.actuators.size() &&
                      gateway_.frame().analogs._length == robot.joint_sensors.size(),
                  "a tick has every channel and input of robot.xml");
    fuzz::require(gateway_.emergencies().size() <= erp::Gateway::max_emergencies &&
                      gateway_.hellos().size() <= erp::Gateway::max_hellos,
                  "the number of stored messages is bounded");
  }

 private:
  void receive(const erp::CanFrame& frame) {
    const auto sequence_before = gateway_.frame().sequence;
    const erp::FrameResult result = gateway_.receive(frame);
    fuzz::require(
        (result == erp::FrameResult::tick) == (gateway_.frame().sequence != sequence_before),
        "a completed tick is reported, and nothing else is");
  }

  void command(fuzz::Input& in) {
    erp::EcuCommand message;
    message.answers = in.take<std::uint8_t>();
    for (int n = in.take<std::uint8_t>() % 65; n > 0; --n)
      erp::append(message.channels, in.take<erp::EcuChannelCommand>());
    for (const erp::CanFrame& frame : gateway_.commands(message)) check_sent(frame, FRAME_COMMAND);
    for (const erp::CanFrame& frame : gateway_.repeat()) check_sent(frame, FRAME_COMMAND);
  }

  void parameter(fuzz::Input& in) {
    erp::EcuParameter message;
    for (int n = in.take<std::uint8_t>(); n > 0; --n) {
      erp::EcuParameterValue value{};
      value.ecu = in.take<std::uint8_t>();
      value.channel = in.take<std::uint8_t>();
      value.index = in.take<std::uint8_t>();
      value.commit = in.take<std::uint8_t>() & 1;
      value.value = in.take<float>();
      erp::append(message.values, value);
    }
    for (const erp::CanFrame& frame : gateway_.parameters(message))
      check_sent(frame, FRAME_PARAMETER);
  }

  static void check_sent(const erp::CanFrame& frame, frame_function function) {
    const auto ecu = frame_ecu_of(&frame);
    fuzz::require(frame_is_intact(&frame) && frame_function_of(&frame) == function,
                  "a sent frame is intact");
    fuzz::require(ecu == 3 || ecu == 4, "frames are sent only to ECUs of robot.xml");
  }

  erp::Gateway gateway_{robot};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input in(data, size);
  Bus bus;
  while (!in.empty()) bus.step(in), bus.check();
  return 0;
}
