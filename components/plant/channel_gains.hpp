#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/core/ecu.h"
#include "interfaces/topics.hpp"
#include "sim/control/gain_design.hpp"

/// The parameters of one ECU channel that the plant is responsible for.
///
///   ECU in state boot               the plant sends the last accepted set; before the first one, the
///                                   set of robot.xml
///   a controller proposes values    sent as one set, one set at a time
///     the ECU accepts the set       it replaces the last accepted one
///     it refuses, or is silent      the set is forgotten
///
/// A controller may change the gains of the control laws, lower a limit or a trip level, and add a
/// check that robot.xml leaves out. It may not exceed a limit of robot.xml or change a scale.
namespace plant {

class ChannelGains {
 public:
  /// `unanswered`: no answer within 1 s, or the ECU has reset.
  enum class Result { none, accepted, refused, unanswered };

  ChannelGains(std::uint8_t ecu, std::uint8_t channel, const sim::EcuParameters& designed)
      : ecu_(ecu), channel_(channel), designed_(designed), accepted_(designed) {}

  /// Why a value is refused; empty: it is accepted.
  std::string refusal(std::string_view parameter, double value) const;
  /// Adds an accepted value to the next set.
  void propose(std::string_view parameter, double value);
  /// Processes the report of the ECU: state, and counts of accepted and refused sets since its boot.
  Result observe(ecu_state state, std::uint8_t accepted, std::uint8_t refused, std::int64_t now_ns);
  bool is_booting() const { return booting_; }
  /// Appends the whole accepted set.
  void append_all(erp::EcuParameter& message) const;
  /// Appends the next set if there is one and none is under way.
  void append_next(erp::EcuParameter& message, std::int64_t now_ns);
  /// `length_gain_V_per_rad = 3.2, …`: the set of the last result.
  std::string text() const;
  float accepted(ecu_parameter_index index) const { return accepted_[index]; }

 private:
  struct Value {
    std::uint8_t index;
    float value;
  };
  Result finish(Result result);
  void append(erp::EcuParameter& message, const Value& value, bool is_last) const;

  std::uint8_t ecu_, channel_;
  sim::EcuParameters designed_, accepted_;
  std::vector<Value> next_, sent_, last_;  ///< to be sent, under way, of the last result
  bool booting_ = false;
  std::int64_t since_boot_ns_ = 0, sent_ns_ = 0;
  std::uint8_t accepted_count_ = 0, refused_count_ = 0;
};

}  // namespace plant
