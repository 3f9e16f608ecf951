// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/waveform/scenario_links.h"

#include <cmath>
#include <utility>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/measured_fading.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/waveform/analytic_signal.h"
#include "acoustics/waveform/linear_phase_filter.h"
#include "bus/config/scenario.h"
#include "channel_server/channel_server_config.h"
#include "core/check.h"
#include "core/elementary.h"
#include "simulation/link_survey.h"

namespace halocline::clients {
namespace {

using acoustics::PathGain;
using channel_server::Reception;

ScenarioConfig with_own_searches(ScenarioConfig config) {
  config.channel_server.propagation.rays.reuse_distance_m = 0;
  return config;
}

// Returns the gains of the paths with their fading at the arrival of the first, by the model or as the
// measured channel that provides the paths.
std::vector<PathGain> gains_of(const Reception& reception, const acoustics::FadingModel& model,
                               const acoustics::FadingLink& pair, SimTime departure,
                               const acoustics::Modem& modem) {
  std::vector<PathGain> gains;
  if (reception.paths.empty()) return gains;
  const SimTime arrival = departure + SimDuration::from_seconds(reception.paths.front().delay_s);
  const acoustics::LinkFading fading(model, pair);
  const double large_scale = fading.large_scale(arrival);
  const auto pressures = reception.measured
                             ? acoustics::MeasuredFading(reception.measured, pair)
                                   .responses(reception.paths, modem.band(), arrival, {}, large_scale)
                             : fading.responses(reception.paths, modem.band(), arrival, {}, large_scale);
  const double sent = amplitude_of(modem.source_level);
  for (std::size_t i = 0; i < reception.paths.size(); ++i) {
    const acoustics::Arrival& path = reception.paths[i];
    gains.push_back({path.identity.number(), path.delay_s, pressures[i] / sent, path.doppler_factor});
  }
  return gains;
}

}  // namespace

double amplitude_of(Decibels level) { return elementary::exp10(level.value / 20); }

ScenarioLinks::ScenarioLinks(const ScenarioConfig& config, const bathymetry::Terrain& terrain,
                             const Recording& run)
    : config_(with_own_searches(config)),
      run_(run),
      modems_(make_modems(config_.channel_server)),
      terrain_(terrain),
      water_(make_water_model(config_.channel_server, config_.scenario)) {}

std::int32_t ScenarioLinks::id_of(const std::string& vehicle) const {
  const bus::VehicleEntry* entry = config_.scenario.find(vehicle);
  require(entry != nullptr, "'" + vehicle + "' is no vehicle of the scenario");
  return entry->id;
}

Way ScenarioLinks::between(const std::string& from, const acoustics::Modem& modem, const std::string& to,
                           double begin_s, double end_s) {
  LinkProgress progress{from, modem, to, begin_s};
  return extend(progress, static_cast<int>(std::ceil((end_s - begin_s) / kFrame.seconds())) + 2);
}

Way ScenarioLinks::extend(LinkProgress& progress, int frames) {
  const VehicleTrack sender(run_, progress.from), receiver(run_, progress.to);
  const double since_s = progress.end_s();
  std::vector<std::vector<PathGain>> paths;
  if (progress.frames > 0) paths.push_back(progress.last);
  for (int k = 0; k < frames; ++k) paths.push_back(next_frame(progress, sender, receiver));
  progress.last = paths.back();
  return {{since_s, kFrame.seconds(), std::move(paths)},
          progress.sum_length_m / progress.frames,
          progress.sum_depth_m / progress.frames,
          progress.modem.centre_frequency_hz};
}

std::vector<PathGain> ScenarioLinks::next_frame(LinkProgress& progress, const VehicleTrack& sender,
                                                const VehicleTrack& receiver) {
  const std::int32_t from = id_of(progress.from), to = id_of(progress.to);
  const acoustics::FadingLink pair{config_.scenario.seed, static_cast<std::uint32_t>(std::min(from, to)),
                                   static_cast<std::uint32_t>(std::max(from, to)), from > to};
  const SimTime departure = SimTime::from_seconds(progress.begin_s) + kFrame * progress.frames++;
  const Reception reception = reception_of(departure, {from, progress.modem, sender.at(departure)},
                                           {to, modem_of(progress.to), {}}, receiver, progress.delay_s);
  progress.sum_length_m += reception.budget.delay_s * reception.budget.mean_sound_speed_mps;
  progress.sum_depth_m +=
      (sender.at(departure).position_ned_m.z() + receiver.at(departure).position_ned_m.z()) / 2;
  return gains_of(reception, config_.channel_server.propagation.fading, pair, departure, progress.modem);
}

// Computes the reception with the receiver where it is at the arrival. `delay_s` is the delay of the previous
// departure (below 0: none) and is set to that of this one.
Reception ScenarioLinks::reception_of(SimTime departure, const End& from, End to,
                                      const VehicleTrack& receiver, double& delay_s) {
  constexpr double kNear = 1500;  // m/s, for a first estimate
  const int turns = delay_s < 0 ? 3 : 1;
  if (delay_s < 0)
    delay_s = (receiver.at(departure).position_ned_m - from.place.position_ned_m).norm() / kNear;
  Reception reception;
  for (int i = 0; i < turns; ++i) {
    to.place = receiver.at(departure + SimDuration::from_seconds(delay_s));
    while (!water_.propagation->is_ready_for_packet(departure, from.link_end(), to.link_end()))
      answer_requests(terrain_, *water_.seabed);
    reception = water_.propagation->reception_without_capacity(departure, from.link_end(), to.link_end());
    delay_s = reception.budget.delay_s;
  }
  return reception;
}

std::vector<double> ScenarioLinks::absorption_taps(const Way& way, SimTime at, double rate_hz,
                                                   double highest_hz) const {
  const acoustics::AbsorptionSpectrum alpha = acoustics::absorption_spectrum_at(water(at), way.depth_m);
  const double centre_db_per_km = alpha.components_at(way.centre_hz).total_db_per_km;
  return acoustics::linear_phase_taps(
      [&](double frequency_hz) {
        if (frequency_hz > highest_hz) return 0.0;
        const double more_db_per_km = alpha.components_at(frequency_hz).total_db_per_km - centre_db_per_km;
        return amplitude_of(Decibels{-more_db_per_km * way.length_m / 1000});
      },
      rate_hz);
}

void ScenarioLinks::add_received(const Way& way, const acoustics::Samples& sound,
                                 acoustics::Samples& received) const {
  const auto taps = absorption_taps(way, SimTime::from_seconds(sound.begin_s), sound.rate_hz);
  way.link.add_received({sound.rate_hz, acoustics::filtered(sound.values, taps)}, sound.begin_s, received);
}

}  // namespace halocline::clients
