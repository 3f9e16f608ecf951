// SPDX-License-Identifier: BSD-3-Clause
// A measured channel as a modem's band meets it: taps over delay whose values over time come from a record.
//
// Model. The band's part of H(t, f) (acoustics/fading/channel_record.h), sampled over delay at the rate of
// its width B:
//   g_n(t) = sum_k h_k(t) exp(-j 2 pi (f0 - fc) tau_k) sinc(n - B tau_k),  f0 the centre of the band, tau_k =
//   k / fs_delay
// of which the sum of |g_n|^2 is the mean of |H|^2 over the band. The sinc ends after 16 lobes: 0.6 % of a
// tap's power at most, none where the band is the record's. Between two instants of the record values are
// linear, and after the last comes the first again. Mean powers are those of the values in between, too: a
// record whose instants are too far apart for its own fading loses power here.
// Kept are the taps that hold 99.9 % of the mean power, from the first one within 20 dB of the strongest on:
// what comes before are noise and sidelobes of the estimate. That tap is of delay 0. In all this leaves out 3
// % of a single sharp tap at most (0.13 dB).
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "acoustics/fading/channel_record.h"
#include "acoustics/math/frequency_band.h"

namespace halocline::acoustics {

// One tap, by its statistics over the record.
struct MeasuredTap {
  double delay_s = 0;    // after the first
  double power = 0;      // mean of |g|^2, above 0
  double coherent = 0;   // share of the power in the mean of g, 0..1
  double phase_rad = 0;  // of that mean, at the centre of the band, without that of the delay
  // Hz rms about its mean frequency, by the correlation of instants next to each other, |R1| / R0 =
  // exp(-(2 pi B / fs_time)^2 / 2); half of fs_time at most.
  double doppler_spread_hz = 0;
};

class MeasuredChannel {
 public:
  // Throws InvalidArgument as validate(record), and unless the record holds the band.
  MeasuredChannel(const ChannelRecord& record, const Band& band);

  const std::vector<MeasuredTap>& taps() const { return taps_; }  // by delay, not empty
  double power() const { return power_; }                         // sum of theirs
  double duration_s() const { return static_cast<double>(instants_) / time_rate_hz_; }

  // g of each tap at each instant `first_s + i * step_s` of the record, which goes on for ever: by tap, then
  // instant. Their phases are those of a path's response: with exp(-j 2 pi f delay) they make H(t, f) but for
  // a phase that is one for all taps.
  std::vector<std::complex<double>> values(double first_s, double step_s, std::size_t count) const;

 private:
  double time_rate_hz_;
  std::size_t instants_;
  std::vector<std::complex<float>> table_;  // [instant * taps + tap]
  std::vector<MeasuredTap> taps_;
  double power_ = 0;
};

}  // namespace halocline::acoustics
