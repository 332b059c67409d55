#include "components/plant/channel_gains.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "interfaces/xml/values.hpp"

namespace plant {
namespace {

/// An ECU reports its counts every 200 ms. Before a set is sent, the count must be known.
constexpr std::int64_t count_period_ns = 250'000'000;
constexpr std::int64_t answer_timeout_ns = 1'000'000'000;  // chosen: 5 reports

#define ERP_GAIN_NAME(id, text) std::string_view(#text),
constexpr std::array names{ECU_PARAMETERS(ERP_GAIN_NAME)};
#undef ERP_GAIN_NAME

constexpr ecu_parameter_index law_gains[] = {
    ECU_PARAMETER_LENGTH_KP,       ECU_PARAMETER_CURRENT_KP,      ECU_PARAMETER_CURRENT_KI,
    ECU_PARAMETER_CURRENT_KD,      ECU_PARAMETER_FORCE_K_CURRENT, ECU_PARAMETER_FORCE_K_SPEED,
    ECU_PARAMETER_FORCE_K_TENSION, ECU_PARAMETER_FORCE_PREFILTER};
/// May be lowered. 0 in robot.xml: there is no such check, and it may be added.
constexpr ecu_parameter_index limits[] = {
    ECU_PARAMETER_CURRENT_LIMIT,      ECU_PARAMETER_CURRENT_TRIP,
    ECU_PARAMETER_TENSION_LIMIT,      ECU_PARAMETER_TENSION_TRIP,
    ECU_PARAMETER_CURRENT_CONTINUOUS, ECU_PARAMETER_OVERLOAD_LIMIT,
    ECU_PARAMETER_TEMPERATURE_DERATE, ECU_PARAMETER_TEMPERATURE_TRIP};
/// Of sensors that robot.xml may leave out.
constexpr ecu_parameter_index added_sensors[] = {ECU_PARAMETER_TEMPERATURE_SCALE,
                                                 ECU_PARAMETER_TEMPERATURE_ZERO};

std::optional<ecu_parameter_index> index_of(std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<ecu_parameter_index>(found - names.begin());
}

bool contains(const auto& list, ecu_parameter_index index) {
  return std::ranges::find(list, index) != std::end(list);
}

}  // namespace

std::string ChannelGains::refusal(std::string_view parameter, double value) const {
  const auto index = index_of(parameter);
  const std::string name(parameter), text = xml::Codec<double>::write(value);
  if (!index) return "there is no gain " + name;
  const auto stored = static_cast<float>(value);
  if (!std::isfinite(stored)) return name + " must be a number, got " + std::to_string(value);
  const float ceiling = designed_[*index];
  const bool is_limit = contains(limits, *index);
  // A larger continuous current would weaken the overload check of robot.xml.
  const bool is_absent = ceiling == 0 && (*index != ECU_PARAMETER_CURRENT_CONTINUOUS ||
                                          designed_[ECU_PARAMETER_OVERLOAD_LIMIT] == 0);
  if (is_limit && !is_absent && !(stored > 0 && stored <= ceiling))
    return name + " must be above 0 and at most robot.xml's " + xml::Codec<float>::write(ceiling) +
           ", got " + text;
  const bool adds_sensor =
      contains(added_sensors, *index) && designed_[ECU_PARAMETER_TEMPERATURE_SCALE] == 0;
  if (!is_limit && !adds_sensor && !contains(law_gains, *index))
    return name + " is a constant of the robot; change it in robot.xml";
  return "";
}

void ChannelGains::propose(std::string_view parameter, double value) {
  const auto index = static_cast<std::uint8_t>(*index_of(parameter));
  std::erase_if(next_, [&](const Value& other) { return other.index == index; });
  next_.push_back({index, static_cast<float>(value)});
}

ChannelGains::Result ChannelGains::finish(Result result) {
  last_ = std::exchange(sent_, {});
  if (result == Result::accepted)
    for (const Value& value : last_) accepted_[value.index] = value.value;
  return result;
}

ChannelGains::Result ChannelGains::observe(ecu_state state, std::uint8_t accepted,
                                           std::uint8_t refused, std::int64_t now_ns) {
  booting_ = state == ECU_STATE_BOOT;
  if (booting_) since_boot_ns_ = now_ns;
  const bool has_accepted = accepted != std::exchange(accepted_count_, accepted);
  const bool has_refused = refused != std::exchange(refused_count_, refused);
  if (sent_.empty()) return Result::none;
  if (booting_ || now_ns - sent_ns_ > answer_timeout_ns) return finish(Result::unanswered);
  if (has_refused) return finish(Result::refused);
  return has_accepted ? finish(Result::accepted) : Result::none;
}

void ChannelGains::append(erp::EcuParameter& message, const Value& value, bool is_last) const {
  erp::append(message.values,
              erp::EcuParameterValue{ecu_, channel_, value.index, is_last, value.value});
}

void ChannelGains::append_all(erp::EcuParameter& message) const {
  for (std::uint8_t i = 0; i < ECU_PARAMETER_COUNT; ++i)
    append(message, {i, accepted_[i]}, i + 1 == ECU_PARAMETER_COUNT);
}

void ChannelGains::append_next(erp::EcuParameter& message, std::int64_t now_ns) {
  if (next_.empty() || !sent_.empty() || booting_ || now_ns - since_boot_ns_ < count_period_ns)
    return;
  sent_ = std::exchange(next_, {});
  sent_ns_ = now_ns;
  for (const Value& value : sent_) append(message, value, &value == &sent_.back());
}

std::string ChannelGains::text() const {
  std::string text;
  for (const Value& value : last_)
    text += (text.empty() ? "" : ", ") + std::string(names[value.index]) + " = " +
            xml::Codec<float>::write(value.value);
  return text;
}

}  // namespace plant
