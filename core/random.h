// SPDX-License-Identifier: BSD-3-Clause
// Counter-based random numbers, addressed by their purpose instead of drawn in sequence.
//
// A draw is a pure function of (seed, purpose, who, which): Philox4x32-10 (Salmon, Moraes, Dror, Shaw 2011,
// "Parallel random numbers: as easy as 1, 2, 3"), a counter-based generator. There is no state: two threads,
// two processes or two runs that compute the same draw get the same number, in whatever order they draw.
//
//   const double u =
//       uniform_at({.seed = 7, .purpose = purpose_of("bit-error"), .who = sender, .which = sequence});
//
// The distributions are implemented here, because those of the standard library differ between
// implementations.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace halocline {

// Philox4x32-10: maps a 128-bit counter and a 64-bit key to 128 random bits.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

// Returns a stable 32-bit number for the name of a purpose (FNV-1a).
constexpr std::uint32_t purpose_of(std::string_view name) {
  std::uint32_t hash = 2166136261u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

// Address of a draw. `who` and `which` identify the object of the draw (a vehicle, a grid cell, a message).
struct DrawAddress {
  std::uint64_t seed = 0;
  std::uint32_t purpose = 0;
  std::uint32_t who = 0;
  std::uint64_t which = 0;
};

// Combines several numbers that together identify an object, in this order, to one number, for use as
// `which`. Two objects have the same number with probability 2^-64.
std::uint64_t identity_of(std::initializer_list<std::uint64_t> parts);

std::uint64_t bits_at(const DrawAddress& address);
// Returns a uniform number in (0, 1), both ends excluded, in steps of 2^-52.
double uniform_at(const DrawAddress& address);
// Returns a standard normal number by the Box-Muller transform, sqrt(-2 ln u1) cos(2 pi u2).
double normal_at(const DrawAddress& address);

}  // namespace halocline
