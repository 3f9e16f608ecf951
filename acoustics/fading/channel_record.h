// SPDX-License-Identifier: BSD-3-Clause
// A measured channel as a file holds it: complex baseband impulse responses h(time, delay) of one receiver.
//
// Files are HDF5, as netCDF-4 and MATLAB 7.3 write it, in the layout of the public replay collections
// (version 1). Axes are named as a C program reads them; MATLAB states them the other way round.
//   h_hat      complex [time, receiver, delay]: a compound of two numbers called real and imag, or r and i
//   params     group of fs_delay and fs_time, rates of the samples over delay and time, Hz, and fc, the
//              carrier, Hz
//   version    1 and up, below 2
//   theta_hat, phi_hat   real [time at fs_delay, receiver], optional: what the motion of the measured ends
//                        did to all
//              delays alike. Checked for their size, which tells the order of the axes, and left out:
//              simulated ends move by themselves. Likewise f_resamp.
// A passband signal of spectrum S(f) is received as S(f) H(t, f), H(t, f) = sum_k h_k(t) exp(-j 2 pi (f - fc)
// k / fs_delay), over fc - fs_delay/2 .. fc + fs_delay/2.
#pragma once

#include <complex>
#include <cstddef>
#include <string>
#include <vector>

#include "acoustics/math/frequency_band.h"

namespace halocline::acoustics {

struct ChannelRecord {
  std::string name;  // of the file and the receiver, for messages
  double carrier_hz = 0, delay_rate_hz = 0, time_rate_hz = 0;
  std::size_t delays = 0;                 // taps of each response
  std::vector<std::complex<float>> taps;  // [instant * delays + delay]

  std::size_t instants() const { return delays > 0 ? taps.size() / delays : 0; }
  double duration_s() const { return static_cast<double>(instants()) / time_rate_hz; }
  Band band() const { return {carrier_hz - delay_rate_hz / 2, carrier_hz + delay_rate_hz / 2}; }
};

inline constexpr std::size_t kMaxRecordDelays = 16'384;
inline constexpr std::size_t kMaxRecordTaps = 50'000'000;  // 400 MB

// Throws InvalidArgument, with the record's name and what is allowed, unless rates are positive and hold the
// carrier, there are 2 instants at least, every tap is finite and one is not 0.
void validate(const ChannelRecord& record);

// Whether all of `band` was measured.
bool holds(const ChannelRecord& record, const Band& band);
// Throws InvalidArgument with both bands and `whose` the second is, unless it was.
void require_holds(const ChannelRecord& record, const Band& band, const std::string& whose);

}  // namespace halocline::acoustics
