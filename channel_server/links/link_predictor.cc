// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/link_predictor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/fading_bounds.h"
#include "acoustics/prediction/link_prediction.h"
#include "acoustics/prediction/reception_statistics.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/signal_history.h"
#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

using acoustics::DisturbingPowers;
using acoustics::LossReason;
using acoustics::Modem;
using acoustics::ReceptionCurves;

constexpr double kMaxCoherenceS = 1e6;
constexpr double kMinDelivery = 1e-3;  // least delivery probability of a rate that counts
constexpr double kSureDelivery = 0.999;

// Returns a modem with only the parameters on which the reception curves depend; all others are the generic
// modem's.
Modem of_packets(const Modem& modem) {
  Modem packets;
  packets.bandwidth_hz = modem.bandwidth_hz;
  packets.centre_frequency_hz = modem.centre_frequency_hz;
  packets.bit_rate_bps = modem.bit_rate_bps;
  packets.packet_overhead = modem.packet_overhead;
  packets.preamble = modem.preamble;
  packets.preamble_pieces = modem.preamble_pieces;
  packets.chip = modem.chip;  // the energy of a pulse
  packets.error_model = modem.error_model;
  packets.layout = modem.layout;
  packets.family = modem.family;
  return packets;
}

// Returns the delivery of one path at a shift of its margin. Below the table nothing is delivered, above it
// what is delivered there.
double shifted_delivery(const OnePathForecast& table, const std::vector<Arrival>& paths, double noise,
                        double shift_db, const acoustics::LinkPrediction& unshifted) {
  const auto found = table.at(paths, noise * elementary::exp10(-shift_db / 10));
  if (found) return found->delivery_probability;
  return shift_db < 0 ? 0 : unshifted.delivery_probability;
}

// True when channel_server/packets rejects the packet before its preamble.
bool is_impossible(const Modem& receiver, const Reception& reception, const Arrival& strongest, bool fades) {
  return !reception.budget.receivable ||
         (!fades && std::abs(strongest.doppler_factor - 1) > receiver.doppler_tolerance);
}

}  // namespace

namespace {

// Returns the power without which a packet of constant ratios would be likeliest to arrive.
LossReason reason_of(const DisturbingPowers& powers, const ReceptionCurves& curves) {
  const auto bits = static_cast<double>(curves.timing().information_bits);
  LossReason best = LossReason::kNone;
  double most = -1, loudest = 0;
  for (const LossReason reason : acoustics::kLossReasons) {
    const double power = powers.of(reason), rest = powers.sum() - power;
    if (!(power > 0)) continue;
    const double sinr = 1 / std::max(rest, 1e-9);
    const double success = curves.acquisition(sinr) * elementary::exp(bits * curves.log_bit_success(sinr));
    // Where no power alone makes a difference it is the greatest.
    if (success > most + 1e-12 || (success > most - 1e-12 && power > loudest)) {
      most = std::max(success, most);
      loudest = power;
      best = reason;
    }
  }
  return best;
}

}  // namespace

LinkPredictor::LinkPredictor(Rule rule) : rule_(std::move(rule)), levels_(rule_.fading.slow) {
  if (rule_.fading.enabled) hours_ = acoustics::margin_quantiles(rule_.fading.slow, rule_.noise.spread_db);
}

SlowState LinkPredictor::slow_state(VehicleId from, VehicleId to, SimTime at) {
  SlowState state;
  const bool are_vehicles = from != 0 && to != 0;
  if (rule_.fading.enabled && are_vehicles && rule_.fading.slow.any()) {
    const acoustics::SlowPair pair{rule_.seed, static_cast<std::uint32_t>(std::min(from, to)),
                                   static_cast<std::uint32_t>(std::max(from, to))};
    state.level_db = levels_.at(pair, at).value;
  }
  if (noise_at_ != at) {
    noise_at_ = at;
    noise_db_ = noise_offset(rule_.noise, rule_.seed, at).value;
  }
  state.margin_db = state.level_db - noise_db_;
  return state;
}

LinkPredictor::Rates LinkPredictor::make_rates(const Modem& transmitter) const {
  Rates rates;
  const auto add = [&](const Modem& modem) {
    // Without payload only a header is left to be decoded; a modem without one sends a byte.
    const std::size_t least = modem.layout.header_bits > 0 ? 0 : 1;
    ReceptionCurves curves(modem, std::clamp(rule_.payload_bytes, least, max_payload_bytes(modem)));
    rates.push_back({curves, OnePathForecast(rule_.fading, curves)});
  };
  add(transmitter);
  const auto of_family = [&](const Modem& modem) { return same_family(modem, transmitter); };
  if (std::count_if(rule_.profiles.begin(), rule_.profiles.end(), of_family) < 2) return rates;
  for (const Modem& profile : rule_.profiles) {
    if (!of_family(profile) || profile.bit_rate_bps == transmitter.bit_rate_bps) continue;
    Modem rate = of_packets(profile);
    rate.bandwidth_hz = transmitter.bandwidth_hz;
    rate.centre_frequency_hz = transmitter.centre_frequency_hz;
    add(rate);
  }
  std::sort(rates.begin() + 1, rates.end(), [](const Rate& a, const Rate& b) {
    return a.curves.modem().bit_rate_bps > b.curves.modem().bit_rate_bps;
  });
  return rates;
}

// A packet with a constant ratio is received at least as often as one whose ratio varies about the same mean
// during the packet, so the bound is computed with constant ratios.
double LinkPredictor::least_sinr_db(const Rates& rates) const {
  double least_db = std::numeric_limits<double>::infinity();
  for (const Rate& rate : rates) {
    const acoustics::ReceptionCurves& curves = rate.curves;
    const auto bits = static_cast<double>(curves.timing().information_bits);
    const auto received = [&](double sinr) {
      return curves.acquisition(sinr) * elementary::exp(bits * curves.log_bit_success(sinr));
    };
    const double of_rate_db = acoustics::least_mean_db(kMinDelivery, [&](double mean_sinr) {
      return acoustics::most_over_fading(rule_.fading, mean_sinr, received);
    });
    least_db = std::min(least_db, of_rate_db);
  }
  return least_db;
}

const LinkPredictor::Entry& LinkPredictor::entry_of(const Modem& transmitter) {
  const Modem packets = of_packets(transmitter);
  auto known =
      std::find_if(kept_.begin(), kept_.end(), [&](const Entry& entry) { return entry.packets == packets; });
  if (known == kept_.end()) {
    if (kept_.size() == kMaxModems) kept_.pop_back();
    const auto rates = std::make_shared<const Rates>(make_rates(packets));
    kept_.push_front({packets, rates, least_sinr_db(*rates)});
  } else {
    kept_.splice(kept_.begin(), kept_, known);
  }
  return kept_.front();
}

std::shared_ptr<const LinkPredictor::Rates> LinkPredictor::rates_of(const Modem& transmitter) {
  return entry_of(transmitter).rates;
}

double LinkPredictor::least_sinr_db(const Modem& transmitter) { return entry_of(transmitter).least_sinr_db; }

LinkForecast LinkPredictor::forecast(const Rates& rates, const Modem& transmitter, const Modem& receiver,
                                     const Reception& reception, const SlowState& slow) const {
  if (reception.paths.empty()) return {};
  std::vector<Arrival> heard;
  const std::vector<Arrival>& paths = without_faint(reception.paths, heard);
  const std::vector<acoustics::LikelyWindow> windows = likely_windows(paths, receiver);
  const acoustics::GuardWindow& window = windows.front().window;
  const Decibels noise = reception.budget.noise_level - receiver.directivity_index +
                         band_loss(transmitter, receiver) + rule_.receiver_margin;
  const double coherence_s = coherence_time_s(paths, window);
  LinkForecast forecast;
  forecast.first_path_delay_s = paths[first_significant(paths)].delay_s;
  forecast.coherence_time_s = std::min(coherence_s, kMaxCoherenceS);
  forecast.doppler_spread_hz = acoustics::doppler_spread_of(coherence_s);
  forecast.rms_delay_spread_s = rms_delay_spread_s(reception.paths);
  const bool impossible = is_impossible(receiver, reception, paths[window.strongest], rule_.fading.enabled);
  // Slow fading changes signal and own echoes alike, so the noise stands for it.
  const double impulses = rule_.impulsive_noise ? to_power_ratio(receiver.impulse_loss).value : 1,
               noise_power = impulses * to_power_ratio(noise - Decibels{slow.level_db}).value;
  if (impossible) {
    forecast.sinr_db = level_of(predicted_sinr(rule_.fading, paths, receiver, windows, transmitter.band(),
                                               noise_power, rates.front().curves))
                           .value;
    return forecast;
  }
  acoustics::MarginShifts shifts;
  if (hours_.low_db != 0 || hours_.high_db != 0)
    shifts = {hours_.low_db - slow.margin_db, hours_.high_db - slow.margin_db};
  double best = 0;
  for (const auto& [curves, one_path] : rates) {
    const double rate_bps = curves.modem().bit_rate_bps;
    const bool own = &curves == &rates.front().curves;
    if (!own && rate_bps <= best) break;  // the rates that follow are slower still
    // For the other rates only the best window is evaluated.
    const auto from_table = one_path.at(paths, noise_factor(receiver) * noise_power);
    acoustics::LinkPrediction predicted =
        from_table ? *from_table
        : own
            ? predict_link(rule_.fading, paths, receiver, windows, transmitter.band(), noise_power, curves,
                           shifts)
            : predict_link(rule_.fading, paths, {&receiver, window}, transmitter.band(), noise_power, curves);
    if (own && from_table && shifts.any()) {
      predicted.delivery_low = shifted_delivery(one_path, paths, noise_power, shifts.low_db, *from_table);
      predicted.delivery_high = shifted_delivery(one_path, paths, noise_power, shifts.high_db, *from_table);
    }
    for (double* share : {&predicted.acquisition_probability, &predicted.delivery_probability,
                          &predicted.delivery_low, &predicted.delivery_high})
      *share *= reception.share_under_water;
    if (own) {
      forecast.sinr_db = level_of(predicted.sinr).value;
      forecast.acquisition_probability = predicted.acquisition_probability;
      forecast.delivery_probability = predicted.delivery_probability;
      forecast.delivery_low = predicted.delivery_low;
      forecast.delivery_high = predicted.delivery_high;
      const DisturbingPowers& d = predicted.disturbances;
      forecast.powers = {.noise = d.noise / impulses,
                         .late_echoes = d.late_echoes,
                         .fast_fading = d.fast_fading,
                         .impulses = d.noise * (1 - 1 / impulses)};
      if (predicted.delivery_probability < kSureDelivery) {
        forecast.reason = reason_of(forecast.powers, curves);
      }
    }
    if (predicted.delivery_probability < kMinDelivery || rate_bps * predicted.delivery_probability <= best)
      continue;
    best = rate_bps * predicted.delivery_probability;
    forecast.best_rate_bps = rate_bps;
  }
  return forecast;
}

}  // namespace halocline::channel_server
