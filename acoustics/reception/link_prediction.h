// What a link will deliver on average over its fading: the expectation of what acoustics/reception/signal_history.h and
// decoding.h decide of single packets.
//
// Model. Within the guard window, at 8 frequencies over the band: steady pressures A_m of the coherent parts, the medium's
// M_m of covariance K, the scattered D_m; interference of the packet's own echoes, each by its overlap with the preamble and
// with the bits, at its mean power.
// - Slow, for a packet: large-scale fading, and the medium together with what is scattered more slowly than a packet lasts.
//   The medium takes 8 states along K A / sqrt(A^H K A), the direction that changes the power most; its rest counts as
//   diffuse. In each, what becomes of a packet is computed at 4 levels of large-scale fading as constant ratios that decide
//   alike, and averaged over 32 strata between them.
// - Preamble: a steady constant and a gamma distributed rest, with the variance that the mean over its time and the band
//   leaves.
// - Coded frequency-shift keying: E exp(-gamma / beta) of Rician gamma is exp(-(c / beta) / (1 + d / beta)) / (1 + d / beta);
//   the finite mean of a block is log-normal about it.
// - Phase-shift keying: the power of the band, likewise distributed, must not fall below what the bits of a fade need, nor
//   cross it (Rice 1944). What the receiver does not track fades as the signal does.
// - Other frequency-shift keying: single errors, each frequency Rician.
// The same numbers for every link, so that predictions vary smoothly. tests/channel_server/packets/link_prediction_test.cc
// compares with judged packets.
// Left out: other packets; the correlation of preamble and bits within one coherence time; paths that share the medium's
// fading; beats of coherent paths of different Doppler; measured channels, which fade as recorded.
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

// `noise` in uPa^2 over the band, less the receiver's directivity. The receiver's modem is the lock's; `curves` are those
// of the packet's.
LinkPrediction predict_link(const FadingModel& model, const std::vector<SoundPath>& paths, const Lock& lock,
                            const Band& band, double noise, const ReceptionCurves& curves);

// The mean over the windows that the receiver may lock to; without fading, of the best.
LinkPrediction predict_link(const FadingModel& model, const std::vector<SoundPath>& paths,
                            const Modem& receiver, const std::vector<LikelyWindow>& windows, const Band& band,
                            double noise, const ReceptionCurves& curves);

// Delay spread, s rms about the mean, weighted by power; 0 of no path.
double rms_delay_spread_s(const std::vector<SoundPath>& paths);

}  // namespace halocline::acoustics
