// What a link will deliver on average over its fading: the expectation of what acoustics/reception/signal_history.h and
// decoding.h decide of single packets.
//
// Model. Within the guard window, at 8 frequencies over the band: steady pressures A_m of the coherent parts, the
// medium's power M and the scattered power D, mean interference I of the packet's own echoes.
// - Slow: large-scale fading, log-normal, and the medium, whose power over the band is taken as gamma distributed with
//   the variance that the correlation of its frequencies leaves, hold through a packet: 24 strata of equal probability of
//   each, in pairs.
// - Fast: what is scattered fades within the packet, in n_t = T / (1.25 coherence time) independent spans and n_f
//   independent parts of the band (from its delays). Coded frequency-shift keying: E exp(-gamma / beta) of Rician gamma is
//   exp(-(c / beta) / (1 + d / beta)) / (1 + d / beta), and its finite mean is spread by 1 / (n_t n_f) of its variance.
//   Others: the chance of a span's bits over a gamma distributed signal, to the power of the spans.
// Left out: other packets; the correlation of preamble and bits within one coherence time.
#pragma once

#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/math/frequency_band.h"
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

// Delay spread, s rms about the mean, weighted by power; 0 of no path.
double rms_delay_spread_s(const std::vector<SoundPath>& paths);

}  // namespace halocline::acoustics
