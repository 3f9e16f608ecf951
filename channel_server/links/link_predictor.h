// SPDX-License-Identifier: BSD-3-Clause
// Forecasts for the rows of link tables: what a link delivers on average over its fading, in addition to its
// budget. The forecast is the mean over the fading of minutes, for the sea as it is: with the pair's slow
// fading at the instant (acoustics/fading/slow_fading.h) and the noise of that instant. The budget is that of
// the mean level, without slow fading. A position without a vehicle has no slow fading.
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
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/slow_fading.h"
#include "acoustics/modem/modem.h"
#include "acoustics/noise/noise_variation.h"
#include "acoustics/prediction/one_path_forecast.h"
#include "acoustics/reception/disturbing_powers.h"
#include "acoustics/reception/reception_curves.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"
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
  // Delivery in one hour of ten at most, and in nine of ten: at quantiles of slow fading and noise. Equal to
  // delivery_probability when neither varies.
  double delivery_low = 0, delivery_high = 0;
  acoustics::DisturbingPowers powers = {};  // means, without other packets
  // The power without which delivery would rise most; kNone where 999 packets in 1000 arrive, or nothing
  // does.
  acoustics::LossReason reason = acoustics::LossReason::kNone;
};

// State of slow fading and noise on one link, dB: level of the pair, and that level less the change of the
// noise, which the reception's noise already has.
struct SlowState {
  double level_db = 0, margin_db = 0;
};

class LinkPredictor {
 public:
  struct Rule {
    // Or a modem's largest payload, if that is less. 0: the header alone, as the JANUS packet without cargo;
    // a modem without a header sends a byte.
    std::size_t payload_bytes = 32;
    acoustics::FadingModel fading;
    std::vector<acoustics::Modem> profiles;  // the known profiles
    acoustics::NoiseVariation noise = {};
    std::uint64_t seed = 0;        // of slow fading and noise, as in the packet medium
    bool impulsive_noise = false;  // true: receivers have their impulse_loss
    Decibels receiver_margin{0};   // noise by which receivers do worse than their profiles
  };
  // A rate of a transmitter. Rates lists its own rate first, then the other rates of its family, the fastest
  // first.
  struct Rate {
    acoustics::ReceptionCurves curves;
    OnePathForecast one_path;
  };
  using Rates = std::vector<Rate>;

  explicit LinkPredictor(Rule rule);

  // Returns the rates of a transmitter. A new modem takes milliseconds; the last kMaxModems modems are
  // cached. Not thread-safe.
  std::shared_ptr<const Rates> rates_of(const acoustics::Modem& transmitter);
  // Returns the mean signal-to-noise ratio, dB, below which no rate of this transmitter delivers one packet
  // in a thousand, however the link fades (acoustics/fading/fading_bounds.h). Not thread-safe.
  double least_sinr_db(const acoustics::Modem& transmitter);
  // Returns the slow state of the link between two vehicles (0: a position) for sound that leaves at `at`.
  // Not thread-safe.
  SlowState slow_state(VehicleId from, VehicleId to, SimTime at);
  // Returns the forecast of a link whose transmitter has these rates. Thread-safe.
  LinkForecast forecast(const Rates& rates, const acoustics::Modem& transmitter,
                        const acoustics::Modem& receiver, const Reception& reception,
                        const SlowState& slow = {}) const;

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
  acoustics::SlowLevels levels_;
  std::optional<SimTime> noise_at_;  // when the noise last asked for is noise_db_
  double noise_db_ = 0;
  acoustics::MarginQuantiles hours_;  // of the margin, both 0 without slow fading
  std::list<Entry> kept_;             // the most recently used first
};

}  // namespace halocline::channel_server
