// SPDX-License-Identifier: BSD-3-Clause
// What the rows of link tables state beside the budget: what the link delivers on average over its fading.
//
// Predictions are those of acoustics/reception/link_prediction.h for packets of one payload, without other
// packets. What the medium decides before it looks at a preamble holds here, too: another family, a level
// below the cut-off and, without fading, a Doppler shift beyond the tolerance deliver nothing.
//
// The rates of a transmitter are those of its family among the known profiles, with the transmitter's band.
// The best has the greatest product of rate and delivery probability; none does that delivers less than one
// packet in a thousand.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <utility>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/reception_curves.h"
#include "channel_server/links/one_path_forecast.h"
#include "channel_server/propagation/propagation.h"
#include "core/units.h"

namespace halocline::channel_server {

// Without paths all is zero.
struct LinkForecast {
  double first_path_delay_s = 0;  // of the first significant path
  double sinr_db = 0;  // mean signal in the guard window over noise and own echoes; kSilence at least
  double acquisition_probability = 0, delivery_probability = 0;
  double coherence_time_s = 0;  // 1e6 at most
  double doppler_spread_hz = 0, rms_delay_spread_s = 0;
  double best_rate_bps = 0;  // 0: nothing is delivered
};

class LinkPredictor {
 public:
  struct Rule {
    std::size_t payload_bytes = 32;  // or a modem's largest, where that is less
    acoustics::FadingModel fading;
    std::vector<acoustics::Modem> profiles;  // known ones
  };
  // Of one transmitter: its own curves first, then those of the family's other rates, the greatest first.
  struct Rate {
    acoustics::ReceptionCurves curves;
    OnePathForecast one_path;
  };
  using Rates = std::vector<Rate>;

  explicit LinkPredictor(Rule rule) : rule_(std::move(rule)) {}

  // Takes milliseconds for a modem that is new; those of kMaxModems are kept. Not thread-safe.
  std::shared_ptr<const Rates> rates_of(const acoustics::Modem& transmitter);
  // The mean ratio, dB, below which no rate of this transmitter delivers a packet in a thousand, however the
  // link fades (acoustics/fading/fading_bounds.h). Not thread-safe.
  double least_sinr_db(const acoustics::Modem& transmitter);
  // Of a link whose transmitter has these rates. Thread-safe.
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
  std::list<Entry> kept_;  // used last, first
};

}  // namespace halocline::channel_server
