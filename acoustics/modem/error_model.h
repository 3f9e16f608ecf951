// SPDX-License-Identifier: BSD-3-Clause
// Bit error rate of an information bit, by the name of a modulation and code.
//
// Eb is always the energy of an information bit, so that models with a code (whose transmitted bits carry
// less energy each) and without one are comparable. Formula, source and limits of each model: bit_error.h,
// convolutional_code.h, block_code.h.
//
// kJanus: the rate of error events per bit, with which blocks are right as often as independent bits of this
// error rate (convolutional_code.h); wrong bits themselves come in bursts of some ten.
//
// kOrthogonal16: orthogonal_symbols.h. kPulses: a pulse of energy E is missed with 1 - P_detect at a false
// alarm of 1e-3 (preamble_detection.h); Eb is that of a pulse, which the modem sends in its chip alone
// (bit_energy() of modem.h).
//
// Rayleigh: each bit (for JANUS each chip) fades independently, which represents bits interleaved over many
// fades. With a single fade a packet, packets would be lost far more seldom at the same mean ratio.
#pragma once

#include <array>
#include <string_view>

#include "core/units.h"

namespace halocline::acoustics {

// Error models of modems.
enum class ErrorModel {
  kNone,           // no bit errors: only the level decides, as in the 2010 IEEE SMC paper
  kBfsk,           // non-coherent binary FSK
  kBfskRayleigh,   // kBfsk, interleaved over Rayleigh fades
  kBpsk,           // coherent binary PSK (or QPSK, which is two of it)
  kBpskRayleigh,   // kBpsk, interleaved over Rayleigh fades
  kDbpsk,          // differential binary PSK
  kDbpskRayleigh,  // kDbpsk, interleaved over Rayleigh fades
  kJanus,          // non-coherent FSK chips, JANUS's convolutional code, soft decisions
  kJanusRayleigh,  // kJanus, interleaved over Rayleigh fades
  kBpskBch64,      // PSK with the extended BCH code (64, 10)
  kBpskHamming14,  // PSK with the shortened Hamming code (14, 9)
  kOrthogonal16,   // one of 16 orthogonal codes a symbol, non-coherent, with parity
  kPulses,         // on-off pulses, non-coherent: a bit is a pulse, wrong where the pulse is missed
};

inline constexpr std::array kErrorModels = {
    ErrorModel::kNone,          ErrorModel::kBfsk,      ErrorModel::kBfskRayleigh,  ErrorModel::kBpsk,
    ErrorModel::kBpskRayleigh,  ErrorModel::kDbpsk,     ErrorModel::kDbpskRayleigh, ErrorModel::kJanus,
    ErrorModel::kJanusRayleigh, ErrorModel::kBpskBch64, ErrorModel::kBpskHamming14, ErrorModel::kOrthogonal16,
    ErrorModel::kPulses};

// Names of the models: "none", "bfsk", "bfsk-rayleigh", "bpsk", "bpsk-rayleigh", "dbpsk", "dbpsk-rayleigh",
// "janus", "janus-rayleigh", "bpsk-bch64", "bpsk-hamming14", "orthogonal16", "pulses".
std::string_view to_name(ErrorModel model);

// True for frequency-shift keying, which includes kNone; false for phase-shift keying.
bool is_frequency_shift_keying(ErrorModel model);
// True for frequency-shift keying with a code.
bool is_coded_frequency_shift_keying(ErrorModel model);

// Bit error rate, 0..0.5 (of kPulses to 0.999), which never increases with eb_over_n0 (>= 0).
double bit_error_rate(ErrorModel model, PowerRatio eb_over_n0);

}  // namespace halocline::acoustics
