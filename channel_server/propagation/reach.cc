// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "acoustics/fading/fading_bounds.h"
#include "acoustics/link/least_loss.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/sea/noise.h"
#include "channel_server/vehicles/modem_rates.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/frames.h"

namespace halocline::channel_server {
namespace {

constexpr std::size_t kMaxRanges = 4096, kMaxModems = 256;
// Depths are rounded up to this times a power of two, m, so that the reach does not change whenever a vehicle
// dives.
constexpr double kDepthUnit = 25;
constexpr double kNever = -std::numeric_limits<double>::infinity();

double rounded_up(double depth_m) {
  double rounded = kDepthUnit;
  while (rounded < depth_m) rounded *= 2;
  return rounded;
}

double least_noise_density(const acoustics::Band& band, const acoustics::NoiseSources& sources) {
  return acoustics::least_noise_power_density(std::max(band.low_hz, 1.0), band.high_hz, sources).value;
}

// Returns the mean signal-to-noise ratio below which a preamble is acquired less often than once in
// `acquired_once_in` packets, dB; -infinity without a preamble.
double unnoticed_sinr_db(const acoustics::Modem& modem, const ReachRule& rule) {
  if (modem.preamble == SimDuration()) return kNever;
  const auto acquired = [&](double sinr) { return acoustics::acquisition_probability(modem, {sinr}); };
  return acoustics::least_mean_db(1 / rule.acquired_once_in, [&](double mean_sinr) {
    return acoustics::most_over_fading(rule.fading, mean_sinr, acquired);
  });
}

bool may_receive(const acoustics::Modem& sender, const acoustics::Modem& receiver) {
  return same_family(sender, receiver) && acoustics::band_share(sender.band(), receiver.band()) > 0;
}

// Returns the noise over the sender's band, less the receiver's directivity index.
Decibels noise_at(const acoustics::Modem& sender, const acoustics::Modem& receiver, PowerRatio density) {
  return to_decibels({density.value * sender.bandwidth_hz}) - receiver.directivity_index;
}

// Returns the level below which `receiver` neither detects sound of `sender` nor is disturbed by it, dB re 1
// uPa over the sender's band. `noise_density`, uPa^2/Hz, is the least over that band; `unnoticed_db` is
// unnoticed_sinr_db() of the sender.
Decibels least_level(const ReachRule& rule, const acoustics::Modem& sender, const acoustics::Modem& receiver,
                     PowerRatio noise_density, double unnoticed_db) {
  const double slow_db = rule.fading.enabled ? rule.fading.slow.rms_db() : 0;
  const Decibels noise =
      noise_at(sender, receiver, noise_density) - Decibels{elementary::hypot(rule.noise_spread_db, slow_db)};
  const Decibels disturbs = noise - rule.below_noise;
  if (!may_receive(sender, receiver)) return disturbs;
  return std::min(disturbs, std::max(noise + Decibels{unnoticed_db} - acoustics::receiver_gain(receiver),
                                     receiver.min_receivable_level));
}

Decibels least_beam_loss(const acoustics::Modem& modem) {
  Decibels least{0};
  for (std::size_t i = 0; i < modem.beam.rows().size(); ++i) {
    const Decibels loss{modem.beam.rows()[i].loss_db};
    least = i == 0 ? loss : std::min(least, loss);
  }
  return least;
}

}  // namespace

// A vehicle of speed v meets sound of speed c after range / (c - v) at the latest, no nearer than
//
//   range - v range / (c - v) = range (1 - v / (c - v))
bool stays_beyond(double reach_m, double range_m, double speed_mps) {
  constexpr double kSpeedingUpMps = 5, kSlowestSoundMps = 1400;
  const double speed = std::min(speed_mps + kSpeedingUpMps, kSlowestSoundMps / 2);
  return range_m * (1 - speed / (kSlowestSoundMps - speed)) > reach_m;
}

ReachModel::ReachModel(std::shared_ptr<const EnvironmentTimeline> waters, const Propagation& propagation,
                       const ReachRule& rule)
    : waters_(std::move(waters)),
      propagation_(propagation),
      rule_(rule),
      ranges_(kMaxRanges),
      unnoticed_(kMaxModems) {
  require_in_range(rule.below_noise.value, 0, 200, "level below the noise that disturbs nobody", "dB");
  require_in_range(rule.acquired_once_in, 10, 1e5, "packets of which one is acquired unnoticed", "");
  require_in_range(rule.table_range_m, 0, acoustics::kMaxBoundedRange, "range of link tables", "m");
}

double ReachModel::reach_m(SimTime at, const acoustics::Modem& sender, const VehicleRegistry& registry,
                           const std::vector<PlacedVehicle>& vehicles) {
  if (!rule_.by_level) return acoustics::kMaxBoundedRange;
  return reach_m(at, sender, crowd_of(at, registry, vehicles));
}

std::vector<double> ReachModel::reception_ranges_m(SimTime at, const VehicleRegistry& registry,
                                                   const std::vector<PlacedVehicle>& vehicles,
                                                   const LeastRatio& least_sinr_db) {
  const double most_m = rule_.table_range_m > 0 ? rule_.table_range_m : acoustics::kMaxBoundedRange;
  if (!rule_.by_level) return std::vector<double>(vehicles.size(), most_m);
  const Crowd crowd = crowd_of(at, registry, vehicles);
  std::vector<double> ranges;
  const acoustics::Modem* last = nullptr;
  for (const PlacedVehicle& vehicle : vehicles) {
    const acoustics::Modem& modem = vehicle.modem->modem;
    const bool is_same = last != nullptr && (last == &modem || *last == modem);
    ranges.push_back(is_same ? ranges.back()
                             : std::min(reception_range_m(at, modem, crowd, least_sinr_db(modem)), most_m));
    last = &modem;
  }
  return ranges;
}

ReachModel::Crowd ReachModel::crowd_of(SimTime at, const VehicleRegistry& registry,
                                       const std::vector<PlacedVehicle>& vehicles) const {
  const double surface_z_m = waters_->at(at).sea_surface_z_m;
  Crowd crowd;
  const auto add_one = [&](const acoustics::Modem& modem) {
    const auto is_known = [&](const acoustics::Modem* known) { return known == &modem || *known == modem; };
    if (std::none_of(crowd.modems.begin(), crowd.modems.end(), is_known)) crowd.modems.push_back(&modem);
  };
  // The vehicle's own modem receives every rate of its family.
  const auto add = [&](const VehicleModem& carried) {
    add_one(carried.modem);
    for (const ModemRate& rate : carried.rates.all()) {
      if (!same_family(rate.modem, carried.modem)) add_one(rate.modem);
    }
  };
  for (const PlacedVehicle& vehicle : vehicles) {
    crowd.deepest_m =
        std::max(crowd.deepest_m, depth_below_surface_m(vehicle.placement.position_ned_m, surface_z_m));
    registry.visit_modems(vehicle.id, at, at + kLongestFlight, add);
  }
  crowd.deepest_m = rounded_up(crowd.deepest_m);
  return crowd;
}

double ReachModel::reach_m(SimTime at, const acoustics::Modem& sender, const Crowd& crowd) {
  double density = least_noise_density(sender.band(), waters_->at(at).noise);
  for (SimTime change = waters_->next_change_after(at); change <= at + kLongestFlight;
       change = waters_->next_change_after(change)) {
    density = std::min(density, least_noise_density(sender.band(), waters_->at(change).noise));
  }
  const double unnoticed_db =
      unnoticed_.find_or_make(key_of(sender), [&] { return unnoticed_sinr_db(sender, rule_); });
  const auto beyond_m = [&](const acoustics::Modem& receiver) {
    return range_m(at, sender, receiver, least_level(rule_, sender, receiver, {density}, unnoticed_db),
                   crowd.deepest_m);
  };
  double reach_m = beyond_m(sender);
  for (const acoustics::Modem* receiver : crowd.modems) reach_m = std::max(reach_m, beyond_m(*receiver));
  return reach_m;
}

double ReachModel::reception_range_m(SimTime at, const acoustics::Modem& sender, const Crowd& crowd,
                                     double least_sinr_db) {
  const PowerRatio density{least_noise_density(sender.band(), waters_->at(at).noise)};
  double longest_m = 0;
  for (const acoustics::Modem* receiver : crowd.modems) {
    if (!may_receive(sender, *receiver)) continue;
    const Decibels least =
        noise_at(sender, *receiver, density) + Decibels{least_sinr_db} - acoustics::receiver_gain(*receiver);
    longest_m = std::max(longest_m, range_m(at, sender, *receiver, least, crowd.deepest_m));
  }
  return longest_m;
}

double ReachModel::range_m(SimTime at, const acoustics::Modem& sender, const acoustics::Modem& receiver,
                           Decibels least, double deepest_m) {
  const Key key{waters_->water_at(at), least.value, deepest_m, key_of(sender), key_of(receiver)};
  return ranges_.find_or_make(key, [&] {
    const auto loss = propagation_.least_loss(at, sender.centre_frequency_hz, deepest_m);
    if (!loss) return acoustics::kMaxBoundedRange;
    const Decibels most = sender.source_level - least_beam_loss(sender) - least_beam_loss(receiver) - least;
    const double range_m = loss->range_of(most);
    const auto weak = propagation_.flux_only_links(at, sender.centre_frequency_hz, deepest_m);
    if (!weak) return range_m;
    const PowerRatio density{least_noise_density(sender.band(), waters_->at(at).noise)};
    const Decibels flux_only_level = noise_at(sender, receiver, density) - weak->below_noise;
    return std::min(range_m, weak->loss.range_of(most, sender.source_level - flux_only_level));
  });
}

ReachModel::ModemKey ReachModel::key_of(const acoustics::Modem& m) {
  std::vector<double> beam;
  for (const acoustics::BeamRow& row : m.beam.rows()) beam.push_back(row.loss_db);
  return {{m.source_level.value, m.min_receivable_level.value, m.centre_frequency_hz, m.bandwidth_hz,
           m.directivity_index.value, m.preamble.seconds(), static_cast<double>(m.preamble_pieces)},
          std::move(beam),
          m.family};
}

}  // namespace halocline::channel_server
