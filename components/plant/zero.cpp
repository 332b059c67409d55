#include "components/plant/zero.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace plant {
namespace {

constexpr std::int64_t repeat_ns = 100'000'000;     // chosen: the ECU confirms within two periods
constexpr std::int64_t timeout_ns = 2'000'000'000;  // chosen: 20 repetitions
constexpr int min_readings = 32;  // chosen: of the potentiometer, 64 ms, to average its noise

}  // namespace

Zero::Zero(const erp::Actuator& actuator, double shaft_rad_per_count,
           const erp::Potentiometer* potentiometer)
    : ecu_(static_cast<std::uint8_t>(actuator.ecu)),
      channel_(static_cast<std::uint8_t>(actuator.channel)),
      rad_per_count_(shaft_rad_per_count) {
  if (potentiometer) range_rad_ = potentiometer->range_rad, start_rad_ = potentiometer->start_rad;
}

Zero::Change Zero::observe(bool known, ecu_state state, std::int32_t counts, std::int64_t now_ns) {
  counts_ = counts;
  const bool has_reset = std::exchange(state_, state) != state && state == ECU_STATE_BOOT;
  if (has_reset) wanted_rad_.reset();  // it was measured before the reset
  if (state == ECU_STATE_BOOT) add_counts_.reset(), readings_ = 0, sum_rad_ = 0;
  const bool was_known = std::exchange(known_, known),
             was_observed = std::exchange(observed_, true);
  if (known && !was_known && add_counts_) {
    wanted_rad_.reset(), add_counts_.reset();
    return Change::set;
  }
  if (wanted_rad_ && now_ns - wanted_since_ns_ > timeout_ns) {
    wanted_rad_.reset(), add_counts_.reset(), readings_ = 0, sum_rad_ = 0;
    return Change::unconfirmed;
  }
  const bool is_intended = wanted_rad_.has_value();  // a known zero is first made unknown
  return !known && !is_intended && (was_known || !was_observed) ? Change::lost : Change::none;
}

/// S_P = S_P0 − shaft. At the ends of its range it reads less than the angle.
void Zero::observe_potentiometer(double reading_rad, std::int64_t now_ns) {
  if (known_ || wanted_rad_ || state_ == ECU_STATE_BOOT) return;
  if (reading_rad <= 0 || reading_rad >= range_rad_) return;
  sum_rad_ += start_rad_ - reading_rad - counts_ * rad_per_count_;
  if (++readings_ < min_readings) return;
  set(counts_ * rad_per_count_ + sum_rad_ / readings_, "its potentiometer", now_ns);
}

void Zero::set(double shaft_rad, const std::string& source, std::int64_t now_ns) {
  wanted_rad_ = shaft_rad;
  add_counts_.reset();
  if (!known_)
    add_counts_ = static_cast<std::int32_t>(std::lround(shaft_rad / rad_per_count_)) - counts_;
  wanted_since_ns_ = now_ns, sent_ns_ = 0;
  source_ = source;
}

/// A known zero is first made unknown, because only then the counts are those since the reset.
void Zero::append_next(erp::EcuParameter& message, std::int64_t now_ns) {
  if (!wanted_rad_ || state_ == ECU_STATE_BOOT || (sent_ns_ && now_ns - sent_ns_ < repeat_ns))
    return;
  if (!known_ && !add_counts_)
    add_counts_ = static_cast<std::int32_t>(std::lround(*wanted_rad_ / rad_per_count_)) - counts_;
  sent_ns_ = now_ns;
  erp::append(message.values,
              erp::EcuParameterValue{ecu_, channel_, ECU_ZERO, false,
                                     known_ ? std::numeric_limits<float>::quiet_NaN()
                                            : static_cast<float>(*add_counts_)});
}

}  // namespace plant
