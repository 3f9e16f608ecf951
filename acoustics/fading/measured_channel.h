// SPDX-License-Identifier: BSD-3-Clause
// A measured channel restricted to a modem's band: taps over delay whose values over time come from a record.
//
// Model. The band's part of H(t, f) (acoustics/fading/channel_record.h) is sampled over delay at the rate of
// its width B:
//   g_n(t) = sum_k h_k(t) exp(-j 2 pi (f0 - fc) tau_k) sinc(n - B tau_k),  tau_k = k / fs_delay,
// with f0 the centre of the band. The sum of |g_n|^2 is the mean of |H|^2 over the band. The sinc is cut off
// after 16 lobes, which loses at most 0.6 % of a tap's power, and nothing when the band is that of the
// record. Values between two instants of the record are interpolated linearly, and the first instant follows
// the last. Mean powers include the values in between, so a record whose instants are too far apart for its
// own fading loses power.
//
// The taps that contain 99.9 % of the mean power are kept, from the first one within 20 dB of the strongest
// on; earlier ones are noise and sidelobes of the channel estimate. The first kept tap has delay 0. All in
// all this leaves out at most 3 % of a single sharp tap (0.13 dB).
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "acoustics/fading/channel_record.h"
#include "acoustics/math/frequency_band.h"

namespace halocline::acoustics {

// A tap, by its statistics over the record.
struct MeasuredTap {
  double delay_s = 0;    // relative to the first tap
  double power = 0;      // mean of |g|^2, above 0
  double coherent = 0;   // share of the power that is in the mean of g, 0..1
  double phase_rad = 0;  // phase of the mean of g at the centre of the band, without that of the delay
  // B, Hz rms about the mean frequency, at most half of fs_time; from the correlation of adjacent instants,
  //   |R1| / R0 = exp(-(2 pi B / fs_time)^2 / 2)
  double doppler_spread_hz = 0;
};

class MeasuredChannel {
 public:
  // Throws InvalidArgument as validate(record), and unless the record covers the band.
  MeasuredChannel(const ChannelRecord& record, const Band& band);

  const std::vector<MeasuredTap>& taps() const { return taps_; }  // sorted by delay; never empty
  double power() const { return power_; }                         // sum of the taps' powers
  double duration_s() const { return static_cast<double>(instants_) / time_rate_hz_; }

  // Returns g of each tap at each instant `first_s + i * step_s` of the record, which repeats forever, in the
  // order of taps, then instants. The phases are those of a path's response: with exp(-j 2 pi f delay) the
  // taps give H(t, f) apart from a phase common to all taps.
  std::vector<std::complex<double>> values(double first_s, double step_s, std::size_t count) const;

 private:
  double time_rate_hz_;
  std::size_t instants_;
  std::vector<std::complex<float>> table_;  // [instant * taps + tap]
  std::vector<MeasuredTap> taps_;
  double power_ = 0;
};

}  // namespace halocline::acoustics
