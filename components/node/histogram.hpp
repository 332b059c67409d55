#pragma once
#include <array>
#include <bit>
#include <cstdint>

/// Histogram of durations in powers of two: bin k counts 2^k … 2^(k+1) µs, bin 0 also counts
/// shorter ones, the last bin also longer ones.
namespace node {

class Histogram {
 public:
  static constexpr std::size_t bins = 24;

  void add_ns(std::int64_t duration_ns) {
    const auto us = static_cast<std::uint64_t>(duration_ns > 0 ? duration_ns / 1000 : 0);
    const auto k = us < 2 ? 0u : static_cast<unsigned>(std::bit_width(us) - 1);
    ++counts_[k < bins ? k : bins - 1];
  }
  const std::array<std::uint32_t, bins>& counts() const { return counts_; }
  void clear() { counts_.fill(0); }

 private:
  std::array<std::uint32_t, bins> counts_{};
};

/// Upper edge, in µs, of the first bin up to which a fraction `q` of the counts lies; 0 when empty.
template <class Bins>
double quantile_us(const Bins& counts, double q) {
  double total = 0, cumulative = 0;
  for (const auto n : counts) total += n;
  double edge = 2;
  for (const auto n : counts) {
    cumulative += n;
    if (total > 0 && cumulative >= q * total) return edge;
    edge *= 2;
  }
  return 0;
}

}  // namespace node
