// SPDX-License-Identifier: BSD-3-Clause
// Forecasts for the rows of link tables: what a link delivers on average over its fading, in addition to its
// budget.
//
// Predictions are those of acoustics/prediction/link_prediction.h for packets of one payload, without other
// packets. Links that the medium rejects before it examines a preamble deliver nothing here, too: those
// between different waveform families, with a level below the cut-off and, without fading, with a Doppler
// shift beyond the tolerance.
//
// The rates considered are those of the known profiles of the transmitter's family, in the transmitter's
// band. The best rate is the one with the greatest product of rate and delivery probability; a rate that
// delivers less than one packet in a thousand does not count.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <utility>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/modem.h"
#include "acoustics/prediction/one_path_forecast.h"
#include "acoustics/reception/reception_curves.h"
#include "channel_server/propagation/propagation.h"
#include "core/units.h"

namespace halocline::channel_server {

// The forecast of one link; all members are 0 without paths.
struct LinkForecast {
  double first_path_delay_s = 0;  // along the first significant path
  double sinr_db = 0;  // mean signal in the guard window over noise and own echoes; at least kSilence
  double acquisition_probability = 0, delivery_probability = 0;
  double coherence_time_s = 0;  // at most 1e6
  double doppler_spread_hz = 0, rms_delay_spread_s = 0;
  double best_rate_bps = 0;  // 0 when no rate delivers
};

class LinkPredictor {
 public:
  struct Rule {
    std::size_t payload_bytes = 32;  // or a modem's largest payload, if that is less
    acoustics::FadingModel fading;
    std::vector<acoustics::Modem> profiles;  // the known profiles
    Decibels receiver_margin{0};             // noise by which receivers do worse than their profiles
  };
  // A rate of a transmitter. Rates lists its own rate first, then the other rates of its family, the fastest
  // first.
  struct Rate {
    acoustics::ReceptionCurves curves;
    OnePathForecast one_path;
  };
  using Rates = std::vector<Rate>;

  explicit LinkPredictor(Rule rule) : rule_(std::move(rule)) {}

  // Returns the rates of a transmitter. A new modem takes milliseconds; the last kMaxModems modems are
  // cached. Not thread-safe.
  std::shared_ptr<const Rates> rates_of(const acoustics::Modem& transmitter);
  // Returns the mean signal-to-noise ratio, dB, below which no rate of this transmitter delivers one packet
  // in a thousand, however the link fades (acoustics/fading/fading_bounds.h). Not thread-safe.
  double least_sinr_db(const acoustics::Modem& transmitter);
  // Returns the forecast of a link whose transmitter has these rates. Thread-safe.
  LinkForecast forecast(const Rates& rates, const acoustics::Modem& transmitter,
                        const acoustics::Modem& receiver, const Reception& reception) const;

 private:
  static constexpr std::size_t kMaxModems = 256;
  struct Entry {
    acoustics::Modem packets;
    std::shared_ptr<const Rates> rates;
    double least_sinr_db;
  };
  const Entry& entry_of(const acoustics::Modem& transmitter);
  Rates make_rates(const acoustics::Modem& transmitter) const;
  double least_sinr_db(const Rates& rates) const;

  Rule rule_;
  std::list<Entry> kept_;  // the most recently used first
};

}  // namespace halocline::channel_server
