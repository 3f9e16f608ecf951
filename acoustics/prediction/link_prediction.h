// SPDX-License-Identifier: BSD-3-Clause
// Expected reception of a link, averaged over its fading: the expectation of the decisions that
// acoustics/reception/signal_history.h and decoding.h make for single packets.
//
// Model.
// - Block fading (constant through a packet): large-scale fading, platform jitter, and the medium together
//   with scattering that is slower than a packet. The power of the medium and the slow scattering takes 8 or
//   16 strata of its distribution (gamma_power.h). In each stratum a packet is represented by the constant
//   ratio of signal to disturbance that has the same outcome. This ratio is needed at 7 levels of large-scale
//   fading and averaged over 32 strata of it (in phase-shift keying over 16 of them, alternating between
//   states). Few of these ratios are computed, the others interpolated (stratified_average.h,
//   link_prediction.cc); none when every packet is certain to arrive or certain to be lost.
// - Late echoes: the power of each fades independently; their sum is gamma distributed. In phase-shift keying
//   this is their block-fading part, during the part of the bits in which they are present.
// - Preamble: the power over the band, with the variance that remains after averaging over the preamble.
// - Coded frequency-shift keying: within the guard window, over the band, the pressure is the sum of steady
//   pressures A_m of the coherent parts (steady_band.h), pressures M_m of covariance K turned by the medium,
//   and scattered pressures D_m. For a Rician gamma of the steady part c and the diffuse part d
//     E exp(-gamma / beta) = exp(-(c / beta) / (1 + d / beta)) / (1 + d / beta);
//   the mean over the finite length of a block is log-normal about it.
// - Phase-shift keying: the mean power over the band (equalizer_statistics.h), the distribution of signal
// over
//   noise and interference within a packet and the duration of its fades (fade_statistics.h). The packet
//   divides into parts that fade independently, each with its share of the bits; all have to be correct.
// - Uncoded frequency-shift keying: independent bit errors, Rician fading at each frequency.
// The same strata and normal variates serve every link, so that predictions vary smoothly with its
// parameters.
//
// Accuracy: tests/channel_server/packets/link_prediction_test.cc compares with simulated packets,
// tests/channel_server/sea/random_places_test.cc at places drawn at random. There the delivery of single
// links of phase-shift keying is within 0.015 rms, 0.11 at worst; uncoded frequency-shift keying is off by up
// to 0.3. Left out: other packets; the correlation of preamble and bits within one coherence time; cross
// terms of coherent paths of different Doppler; in frequency-shift keying, paths that share the medium's
// fading; measured channels, which fade as recorded.
#pragma once

#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/disturbing_powers.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/reception_curves.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

// Expected reception of one link.
struct LinkPrediction {
  double sinr = 0;                     // ratio of the mean signal to noise plus mean own interference
  double acquisition_probability = 0;  // probability of detecting the preamble
  double delivery_probability = 0;     // probability of detecting the preamble and decoding all bits
  // The same with the margin shifted by MarginShifts; equal to it without shifts and without fading.
  double delivery_low = 0, delivery_high = 0;
  DisturbingPowers disturbances = {};  // of the mean signal, without other packets and impulses
};

// Changes of a link's margin, dB, at which delivery is predicted beside that of the link as it is: slow
// fading at its quantiles (acoustics/fading/slow_fading.h). Both 0: none are predicted. The states of block
// fading are those of the link as it is, in frequency-shift keying half of them: together the two cost about
// two thirds of a prediction (coded frequency-shift keying) to a whole one (phase-shift keying). They are
// within 0.015 rms of predictions of their own. Of several windows the others lose and gain in proportion to
// the best one. Delivery is never less than at the lower margin nor more than at the higher one.
struct MarginShifts {
  double low_db = 0, high_db = 0;
  bool any() const { return low_db != 0 || high_db != 0; }
};

// Prediction for one window. `noise` is the power over the band, uPa^2, less the receiver's directivity
// index and before its loss and hydrophones (acoustics/modem/modem.h). The receiver's modem is that of
// `sync`; `curves` belong to the packet's modem and payload. Without paths all results are 0.
LinkPrediction predict_link(const FadingModel& model, const std::vector<Arrival>& paths,
                            const Synchronisation& sync, const Band& band, double noise,
                            const ReceptionCurves& curves, const MarginShifts& shifts = {});

// Mean of the predictions over the windows that the receiver may choose; without fading the prediction for
// the best window.
LinkPrediction predict_link(const FadingModel& model, const std::vector<Arrival>& paths,
                            const Modem& receiver, const std::vector<LikelyWindow>& windows, const Band& band,
                            double noise, const ReceptionCurves& curves, const MarginShifts& shifts = {});

// The `sinr` of that prediction alone, which is faster to compute.
double predicted_sinr(const FadingModel& model, const std::vector<Arrival>& paths, const Modem& receiver,
                      const std::vector<LikelyWindow>& windows, const Band& band, double noise,
                      const ReceptionCurves& curves);

}  // namespace halocline::acoustics
