#pragma once
#include <cstdint>
#include <random>

/// Independent random streams. Results then do not depend on the order of the draws.
namespace sim::training_loop {

/// The generator of a seed and up to two numbers, for instance a round and an index in it. Streams
/// of different arguments are practically independent (std::seed_seq mixes the arguments).
inline std::mt19937_64 random_stream(std::uint64_t seed, std::uint64_t round = 0,
                                     std::uint64_t index = 0) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); };
  std::seed_seq sequence{low(seed), high(seed), low(round), high(round), low(index), high(index)};
  return std::mt19937_64(sequence);
}

}  // namespace sim::training_loop
