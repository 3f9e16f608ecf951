// SPDX-License-Identifier: BSD-3-Clause
// A measured channel as stored in a file: complex baseband impulse responses h(time, delay) of one receiver.
//
// Files are HDF5, as written by netCDF-4 and MATLAB 7.3, in the layout of the public replay collections
// (version 1). The axes are in the order in which a C program reads them; MATLAB shows them reversed.
//   h_hat               complex [time, receiver, delay]: a compound of two numbers called
//                       real and imag, or r and i
//   params              group of fs_delay and fs_time, the sampling rates over delay and time,
//                       Hz, and fc, the carrier, Hz
//   version             1 and up, below 2
//   theta_hat, phi_hat  real [time at fs_delay, receiver], optional: the effect of the motion
//                       of the measured ends, common to all delays
// The sizes of theta_hat and phi_hat are checked, because they tell the order of the axes. Their values are
// ignored, as is f_resamp, because simulated ends move by themselves.
//
// A passband signal of spectrum S(f) is received as S(f) H(t, f), over fc - fs_delay/2 .. fc + fs_delay/2,
// with
//   H(t, f) = sum_k h_k(t) exp(-j 2 pi (f - fc) k / fs_delay).
#pragma once

#include <complex>
#include <cstddef>
#include <string>
#include <vector>

#include "acoustics/math/frequency_band.h"

namespace halocline::acoustics {

struct ChannelRecord {
  std::string name;  // file and receiver, for messages
  double carrier_hz = 0, delay_rate_hz = 0, time_rate_hz = 0;
  std::size_t delays = 0;                 // taps per response
  std::vector<std::complex<float>> taps;  // [instant * delays + delay]

  std::size_t instants() const { return delays > 0 ? taps.size() / delays : 0; }
  double duration_s() const { return static_cast<double>(instants()) / time_rate_hz; }
  Band band() const { return {carrier_hz - delay_rate_hz / 2, carrier_hz + delay_rate_hz / 2}; }
};

inline constexpr std::size_t kMaxRecordDelays = 16'384;
inline constexpr std::size_t kMaxRecordTaps = 50'000'000;  // 400 MB

// Throws InvalidArgument, with the record's name and what is permitted, unless the rates are positive, the
// carrier is at least half of the delay rate, there are at least 2 instants, and every tap is finite and at
// least one is not 0.
void validate(const ChannelRecord& record);

// True when the record covers all of `band`.
bool holds(const ChannelRecord& record, const Band& band);
// Throws InvalidArgument, with both bands and `whose` band the second is, unless the record covers `band`.
void require_holds(const ChannelRecord& record, const Band& band, const std::string& whose);

}  // namespace halocline::acoustics
