// SPDX-License-Identifier: BSD-3-Clause
// Simulated receiver of the JANUS code: chips of non-coherent FSK in white noise, soft decisions, Viterbi
// decoder. The table in acoustics/modem/convolutional_code.cc is its result with 20 000 blocks a row.
//
// A block has its bits and 8 zeros that end the code. Each coded bit is a chip on one of two tones: the
// amplitude sqrt(Ec / N0) on its own tone, complex normal noise of power 1 on both. The decoder adds the
// differences of power |r_1|^2 - |r_0|^2 along the trellis of 256 states and takes the path of the greatest
// sum from state 0 to state 0. An interleaver changes nothing where chips are independent.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "acoustics/modem/convolutional_code.h"

namespace halocline::acoustics {

class SimulatedViterbi {
 public:
  explicit SimulatedViterbi(std::uint64_t seed) : random_(seed) {
    for (unsigned state = 0; state < kStates; ++state) {
      for (const unsigned bit : {0u, 1u}) sent_[state][bit] = word_of(state, bit);
    }
  }

  // Share of `blocks` of `bits` bits that are decoded with an error at chips of Ec/N0 `chip_snr`, a ratio;
  // with `fades` each chip has an exponentially distributed power of that mean.
  double block_error_rate(double chip_snr, std::size_t bits, int blocks, bool fades) {
    int wrong = 0;
    for (int i = 0; i < blocks; ++i) wrong += is_wrong(chip_snr, bits, fades);
    return static_cast<double>(wrong) / blocks;
  }

 private:
  static constexpr unsigned kStates = 256, kTail = 8;

  // The two coded bits of a branch, the first in the place of 2.
  static unsigned word_of(unsigned state, unsigned bit) {
    const unsigned word = (bit << kTail) | state;
    const auto parity = [&](unsigned generator) {
      return static_cast<unsigned>(std::popcount(word & generator)) & 1u;
    };
    return 2 * parity(kJanusCode.generators[0]) + parity(kJanusCode.generators[1]);
  }

  float chip(double amplitude, bool one) {
    const auto power = [&](double signal) {
      const double re = signal + noise_(random_), im = noise_(random_);
      return re * re + im * im;
    };
    const double high = power(one ? amplitude : 0), low = power(one ? 0 : amplitude);
    return static_cast<float>(high - low);
  }

  bool is_wrong(double chip_snr, std::size_t bits, bool fades) {
    std::vector<unsigned> sent(bits + kTail, 0);
    for (std::size_t i = 0; i < bits; ++i) sent[i] = static_cast<unsigned>(random_() & 1);
    std::vector<float> chips;
    unsigned state = 0;
    for (const unsigned bit : sent) {
      for (const unsigned place : {2u, 1u}) {
        const double power = fades ? chip_snr * fade_(random_) : chip_snr;
        chips.push_back(chip(std::sqrt(power), (sent_[state][bit] & place) != 0));
      }
      state = (bit << (kTail - 1)) | (state >> 1);
    }
    return decoded(chips) != sent;
  }

  std::vector<unsigned> decoded(const std::vector<float>& chips) const {
    const std::size_t steps = chips.size() / 2;
    std::vector<std::array<std::uint8_t, kStates>> from(steps);
    std::array<float, kStates> sums, next;
    sums.fill(-1e30f);
    sums[0] = 0;
    for (std::size_t t = 0; t < steps; ++t) {
      const float a = chips[2 * t], b = chips[2 * t + 1];
      const std::array<float, 4> branch{-a - b, -a + b, a - b, a + b};
      for (unsigned to = 0; to < kStates; ++to) {
        const unsigned bit = to >> (kTail - 1), even = (to << 1) & (kStates - 1), odd = even | 1;
        const float of_even = sums[even] + branch[sent_[even][bit]],
                    of_odd = sums[odd] + branch[sent_[odd][bit]];
        from[t][to] = of_odd > of_even;
        next[to] = of_odd > of_even ? of_odd : of_even;
      }
      sums = next;
    }
    std::vector<unsigned> bits(steps);
    unsigned state = 0;
    for (std::size_t t = steps; t-- > 0;) {
      bits[t] = state >> (kTail - 1);
      state = ((state << 1) & (kStates - 1)) | from[t][state];
    }
    return bits;
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> noise_{0, std::sqrt(0.5)};
  std::exponential_distribution<double> fade_{1};
  std::array<std::array<unsigned, 2>, kStates> sent_;
};

}  // namespace halocline::acoustics
