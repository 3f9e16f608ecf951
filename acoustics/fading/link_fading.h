// SPDX-License-Identifier: BSD-3-Clause
// The fading of all paths of one link over time (the model: acoustics/fading/path_fading.h).
//
// A value is a function of (seed, pair of ends, identity of the path, absolute time of arrival) without any
// state: threads, processes and the order of calls agree to the bit. Both directions of a link fade alike.
//   X    large scale, dB: a Gauss-Markov process of the pair (core/gauss_markov.h) with mean -sigma^2 ln(10)
//        / 20, which leaves the mean power as it is
//   g_s  scattered: complex noise of the path's own (acoustics/fading/complex_noise.h)
//   g_m  medium: one field of the pair over time, delay and the angles at both ends. Paths close in all of
//        them cross the same water and fade together: their correlation is exp(-|x - y|^2 / 2), x = (2 B
//        (delay - mean delay), launch angle / 4 degrees, arrival angle / 4 degrees), B the bandwidth and the
//        mean delay weighted by power (our choice of scales: within 2 degrees the correlation is above 0.88;
//        smooth, so that no path changes its fading suddenly).
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "acoustics/fading/complex_noise.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/path_responses.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/math/frequency_band.h"
#include "core/gauss_markov.h"
#include "core/sim_time.h"

namespace halocline::acoustics {

// Which link fades. `reversed` from the higher to the lower of the two ends: its angles are exchanged.
struct FadingLink {
  std::uint64_t seed = 0;
  std::uint32_t lower_id = 0, higher_id = 0;
  bool reversed = false;
};

class LinkFading : public PathResponses {
 public:
  // Throws InvalidArgument as validate(FadingModel).
  LinkFading(const FadingModel& model, const FadingLink& link);

  // 10^(X/20) at `time`; 1 when nothing fades.
  double large_scale(SimTime time) const;

  std::vector<std::complex<double>> responses(const std::vector<SoundPath>& paths, const Band& band,
                                              SimTime start, const FadingTimes& times,
                                              double large_scale) const override;

 private:
  FadingModel model_;
  FadingLink link_;
};

// Mean over fading, and over the band, of the power of all paths together, uPa^2:
//   sum P s + sum over pairs of sqrt(P_p P_q) (sqrt(c_p c_q) + sqrt(m_p m_q) corr_pq) cos(phase difference at
//   the centre) sinc(B (delay_p - delay_q))
// A model that is not enabled adds the powers.
double mean_power(const FadingModel& model, const std::vector<SoundPath>& paths, const Band& band);

}  // namespace halocline::acoustics
