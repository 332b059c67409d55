#pragma once
#include <cstdint>
#include <random>

/// Dice of their own for each thing that is drawn for, so that it does not matter who draws first.
namespace sim::training_loop {

/// Of a seed and up to two numbers, say a round and a place in it. Different ones are as good as
/// independent (the engine's seed sequence mixes them).
inline std::mt19937_64 dice(std::uint64_t seed, std::uint64_t round = 0, std::uint64_t place = 0) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); };
  std::seed_seq all{low(seed), high(seed), low(round), high(round), low(place), high(place)};
  return std::mt19937_64(all);
}

}  // namespace sim::training_loop
