// SPDX-License-Identifier: BSD-3-Clause
// What a link will deliver on average over its fading: the expectation of what
// acoustics/reception/signal_history.h and decoding.h decide of single packets.
//
// Model.
// - Slow, for a packet: large-scale fading, sway of the ends, and the medium together with what is scattered
//   more slowly than a packet lasts. The power of the latter takes 8 or 16 strata of its distribution
//   (power_law.h); in each, what becomes of a packet is a constant ratio that decides alike, at 7 levels,
//   averaged over 32 strata of large-scale fading, of phase-shift keying 16 by turns. Few of these ratios are
//   computed, the others interpolated (strata_mean.h, link_prediction.cc); none where all packets are certain
//   to arrive or not.
// - Late echoes: their powers fade each by itself, a gamma distribution in all. Of phase-shift keying that is
//   what fades slowly, while they sound: through a part of the bits.
// - Preamble: the power of the band, with the variance that the mean over its time leaves.
// - Coded frequency-shift keying: within the guard window, over the band, steady pressures A_m of the
//   coherent parts (steady_band.h), the medium's M_m of covariance K, the scattered D_m. E exp(-gamma / beta)
//   of Rician gamma is exp(-(c / beta) / (1 + d / beta)) / (1 + d / beta); the finite mean of a block is
//   log-normal about it.
// - Phase-shift keying: the mean power over the band (collected_sound.h), how signal over noise and
//   interference fades within a packet and how long its fades last (band_law.h); the parts of a packet that
//   fade independently, each with its share of the bits, all have to be right.
// - Other frequency-shift keying: single errors, each frequency Rician.
// The same numbers for every link, so that predictions vary smoothly.
// tests/channel_server/packets/link_prediction_test.cc compares with judged packets,
// tests/channel_server/sea/random_places_test.cc at places drawn at random: of single links there the
// delivery of phase-shift keying is within 0.015 rms, 0.11 at worst; uncoded frequency-shift keying is off by
// up to 0.3. Left out: other packets; the correlation of preamble and bits within one coherence time; beats
// of coherent paths of different Doppler; of frequency-shift keying, paths that share the medium's fading;
// measured channels, which fade as recorded.
#pragma once

#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/reception_curves.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

struct LinkPrediction {
  double sinr = 0;                     // mean signal over noise and mean own interference
  double acquisition_probability = 0;  // of the preamble
  double delivery_probability = 0;     // of acquisition and all bits
};

// `noise` in uPa^2 over the band, less the receiver's directivity. The receiver's modem is the lock's;
// `curves` are those of the packet's.
LinkPrediction predict_link(const FadingModel& model, const std::vector<SoundPath>& paths, const Lock& lock,
                            const Band& band, double noise, const ReceptionCurves& curves);

// The mean over the windows that the receiver may lock to; without fading, of the best.
LinkPrediction predict_link(const FadingModel& model, const std::vector<SoundPath>& paths,
                            const Modem& receiver, const std::vector<LikelyWindow>& windows, const Band& band,
                            double noise, const ReceptionCurves& curves);

// Of these, the ratio alone.
double predicted_sinr(const FadingModel& model, const std::vector<SoundPath>& paths, const Modem& receiver,
                      const std::vector<LikelyWindow>& windows, const Band& band, double noise,
                      const ReceptionCurves& curves);

// Delay spread, s rms about the mean, weighted by power; 0 of no path.
double rms_delay_spread_s(const std::vector<SoundPath>& paths);

}  // namespace halocline::acoustics
