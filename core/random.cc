// SPDX-License-Identifier: BSD-3-Clause
#include "core/random.h"

#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace halocline {
namespace {

// Constants of Salmon et al. 2011, table 2 and section 3.3.
constexpr std::uint32_t kMultiplier0 = 0xD2511F53u, kMultiplier1 = 0xCD9E8D57u;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9u, kWeyl1 = 0xBB67AE85u;
constexpr int kRounds = 10;

std::array<std::uint32_t, 4> block_at(const DrawAddress& a) {
  // Seed (64 bits), purpose (32), who (32) and which (64) fill the 192 bits of key and counter, unmixed.
  return philox4x32(
      {static_cast<std::uint32_t>(a.which), static_cast<std::uint32_t>(a.which >> 32), a.who, a.purpose},
      {static_cast<std::uint32_t>(a.seed), static_cast<std::uint32_t>(a.seed >> 32)});
}

// Returns (k + 1/2) / 2^52 for the top 52 bits k: exact in a double, and never 0 or 1.
double to_open_unit_interval(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t{high} << 32 | low) >> 12;
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t product0 = std::uint64_t{kMultiplier0} * counter[0];
    const std::uint64_t product1 = std::uint64_t{kMultiplier1} * counter[2];
    counter = {static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0],
               static_cast<std::uint32_t>(product1),
               static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1],
               static_cast<std::uint32_t>(product0)};
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return counter;
}

// Each part is encrypted with the result of the previous ones as the key: a chain of bijections.
std::uint64_t identity_of(std::initializer_list<std::uint64_t> parts) {
  std::uint64_t identity = parts.size();
  for (const std::uint64_t part : parts) {
    identity = bits_at({.seed = identity, .purpose = purpose_of("identity"), .which = part});
  }
  return identity;
}

std::uint64_t bits_at(const DrawAddress& address) {
  const auto block = block_at(address);
  return std::uint64_t{block[0]} << 32 | block[1];
}

double uniform_at(const DrawAddress& address) {
  const auto block = block_at(address);
  return to_open_unit_interval(block[0], block[1]);
}

double normal_at(const DrawAddress& address) {
  const auto block = block_at(address);
  const double radius = std::sqrt(-2.0 * elementary::log(to_open_unit_interval(block[0], block[1])));
  return radius * elementary::cos(2.0 * std::numbers::pi * to_open_unit_interval(block[2], block[3]));
}

}  // namespace halocline
