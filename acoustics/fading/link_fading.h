// SPDX-License-Identifier: BSD-3-Clause
// Fading of all paths of one link over time. The model is that of acoustics/fading/path_fading.h.
//
// A value is a function of (seed, pair of ends, identity of the path, absolute time of arrival) without
// state, so threads, processes and orders of calls agree to the last bit. Both directions of a link fade
// alike.
//   X    large-scale fading, dB: a Gauss-Markov process of the pair (core/gauss_markov.h) with the
//        mean -sigma^2 ln(10) / 20, which preserves the mean power
//   Y    slow fading of the pair, dB (acoustics/fading/slow_fading.h)
//   g_s  scattered: complex noise of each path (acoustics/fading/complex_noise.h)
//   g_m  medium: one random field of the pair over time, delay and the angles at both ends
// Paths that are close in delay and angles cross the same water and fade together. The correlation of their
// g_m is exp(-|x - y|^2 / 2), with
//   x = (2 B (delay - mean delay), launch angle / 4 degrees, arrival angle / 4 degrees),
// B the bandwidth and the mean delay weighted by power. The scales are our choice: within 2 degrees the
// correlation is above 0.88, and it is smooth, so that no path changes its fading suddenly.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/complex_noise.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/path_responses.h"
#include "acoustics/math/frequency_band.h"
#include "core/gauss_markov.h"
#include "core/sim_time.h"

namespace halocline::acoustics {

// The link that fades. `reversed` means from the higher to the lower identifier; the angles are then
// exchanged.
struct FadingLink {
  std::uint64_t seed = 0;
  std::uint32_t lower_id = 0, higher_id = 0;
  bool reversed = false;
  bool at_rest = false;  // neither end moves: FadingModel::large_scale_still_s counts
};

// The modelled responses of a link's paths.
class LinkFading : public PathResponses {
 public:
  // Throws InvalidArgument as validate(FadingModel).
  LinkFading(const FadingModel& model, const FadingLink& link);

  // Factor of large-scale and slow fading at `time`, 10^((X + Y)/20); 1 when nothing fades.
  double large_scale(SimTime time) const;

  std::vector<std::complex<double>> responses(const std::vector<Arrival>& paths, const Band& band,
                                              SimTime start, const FadingTimes& times,
                                              double large_scale) const override;

 private:
  FadingModel model_;
  FadingLink link_;
};

// Mean over fading and over the band of the power of all paths together, uPa^2:
//   sum of P_p + sum over pairs p != q of
//     sqrt(P_p P_q) (sqrt(c_p c_q) + sqrt(m_p m_q) corr_pq)
//     cos(phase difference at the centre) sinc(B (delay_p - delay_q)) g_pq
// with g the mean over the vertical movement J of both ends (FadingModel::platform_jitter_m),
//   g = exp(-(k J)^2 ((sin launch_p - sin launch_q)^2 + (sin arrival_p - sin arrival_q)^2) / 2):
// a level is one of a link, not of a point.
// A model that is not enabled adds the powers only.
double mean_power(const FadingModel& model, const std::vector<Arrival>& paths, const Band& band);

}  // namespace halocline::acoustics
