// SPDX-License-Identifier: BSD-3-Clause
// Bit error rate of an information bit, by the name of modulation and code.
//
// Eb is always the energy of an information bit, so a model with a code (bits of the air carry less each) and
// one without compare fairly. Each model's formula, source and limits: bit_error.h, convolutional_code.h,
// block_code.h.
//
// Rayleigh: each bit (of JANUS: each chip) fades by itself. That stands for bits interleaved over many fades;
// with one fade a packet, packets would be lost far more seldom at the same mean ratio.
#pragma once

#include <array>
#include <string_view>

#include "core/units.h"

namespace halocline::acoustics {

enum class ErrorModel {
  kNone,           // no bit is ever wrong: only the level decides, as in the 2010 IEEE SMC paper
  kBfsk,           // non-coherent binary FSK
  kBfskRayleigh,   // the same, interleaved over Rayleigh fades
  kBpsk,           // coherent binary PSK (or QPSK, which is two of it)
  kBpskRayleigh,   // likewise
  kDbpsk,          // differential binary PSK
  kDbpskRayleigh,  // likewise
  kJanus,          // non-coherent FSK chips, JANUS's convolutional code, soft decisions
  kJanusRayleigh,  // the same, interleaved over Rayleigh fades
  kBpskBch64,      // PSK with the extended BCH code (64, 10)
  kBpskHamming14,  // PSK with the shortened Hamming code (14, 9)
};

inline constexpr std::array kErrorModels = {
    ErrorModel::kNone,          ErrorModel::kBfsk,      ErrorModel::kBfskRayleigh,  ErrorModel::kBpsk,
    ErrorModel::kBpskRayleigh,  ErrorModel::kDbpsk,     ErrorModel::kDbpskRayleigh, ErrorModel::kJanus,
    ErrorModel::kJanusRayleigh, ErrorModel::kBpskBch64, ErrorModel::kBpskHamming14};

// "none", "bfsk", "bfsk-rayleigh", "bpsk", "bpsk-rayleigh", "dbpsk", "dbpsk-rayleigh", "janus",
// "janus-rayleigh", "bpsk-bch64", "bpsk-hamming14".
std::string_view to_name(ErrorModel model);

// Whether it is of tones (as `none` is taken to be), or of phases.
bool is_frequency_shift_keying(ErrorModel model);
// Whether it is of tones with a code over them.
bool is_coded_frequency_shift_keying(ErrorModel model);

// 0..0.5, never rising as eb_over_n0 (>= 0) rises.
double bit_error_rate(ErrorModel model, PowerRatio eb_over_n0);

}  // namespace halocline::acoustics
