#pragma once
#include <cstdint>
#include <limits>

namespace erp::can {

/// Aligns a CAN controller's clock with the system clock, by the smallest delay observed:
///
///   t = t_hw + min (t_kernel − t_hw)   over the last one to two spans
///
/// The kernel stamps a frame when the driver hands it over, never before it was on the wire. The
/// frame with the smallest delay determines the offset. Spans of 10 s (chosen) limit the error by
/// clock drift: 50 ppm are 0.5 ms per span.
class StampClock {
 public:
  /// Time at which a frame was on the wire; without a hardware stamp (0) the kernel's time.
  std::int64_t stamp_ns(std::int64_t kernel_ns, std::int64_t hardware_ns) {
    if (hardware_ns == 0) return kernel_ns;
    const std::int64_t offset_ns = kernel_ns - hardware_ns;
    if (span_start_ns_ == no_time || kernel_ns - span_start_ns_ > span_ns)
      last_min_ns_ = min_ns_, min_ns_ = no_time, span_start_ns_ = kernel_ns;
    if (offset_ns < min_ns_) min_ns_ = offset_ns;
    return hardware_ns + (last_min_ns_ < min_ns_ ? last_min_ns_ : min_ns_);
  }

  static constexpr std::int64_t span_ns = 10'000'000'000;

 private:
  static constexpr std::int64_t no_time = std::numeric_limits<std::int64_t>::max();
  std::int64_t span_start_ns_ = no_time, min_ns_ = no_time, last_min_ns_ = no_time;
};

}  // namespace erp::can
