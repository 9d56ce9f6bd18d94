// engine/random.h - uniform numbers that depend on nothing but what they are for, the same on every machine.
//
// Counter-based: a number is a hash of the seed and of indices, so that leaving a particle out moves no other one. The hash
// is SplitMix64 (Steele, Lea, Flood 2014; constants of Stafford's mix 13).
#pragma once
#include <cstdint>

namespace skred {

constexpr std::uint64_t mix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

// In [0, 1): the upper 53 bits as a multiple of 2^-53, which is exact.
constexpr double uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t index, std::uint64_t draw) {
  const std::uint64_t bits = mix64(mix64(mix64(mix64(seed) ^ stream) ^ index) ^ draw);
  return double(bits >> 11) * 0x1p-53;
}

}  // namespace skred
