// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/link_surveyor.h"

#include <string>
#include <utility>

#include "acoustics/math/frequency_band.h"
#include "acoustics/sea/noise.h"
#include "bus/config/scenario.h"
#include "channel_server/links/receiver_noise.h"
#include "channel_server/vehicles/state_history.h"
#include "core/check.h"
#include "core/units.h"
#include "simulation/link_survey.h"

namespace halocline::clients {

using channel_server::LinkEnd;

namespace {

// Vehicles are at rest at their starts since before time 0, so that sound they radiated earlier has arrived.
channel_server::PositionRule at_rest() {
  return {.state_lag = SimDuration(), .state_timeout = channel_server::kLongestFlight * 2};
}

}  // namespace

LinkSurveyor::LinkSurveyor(const ScenarioConfig& config, std::shared_ptr<const bathymetry::Terrain> terrain,
                           const channel_server::WaterSources& sources)
    : terrain_(std::move(terrain)),
      rules_(make_rules(config.channel_server, config.scenario)),
      water_(make_water_model(config.channel_server, sources)),
      fleet_(at_rest(), make_modems(config.channel_server),
             make_equipment(config.channel_server, config.scenario)),
      reach_(water_.waters, *water_.propagation, rules_.reach),
      sounds_(fleet_, *water_.propagation, &reach_, rules_.medium.fading, rules_.medium.noise,
              rules_.medium.seed),
      noise_(sounds_),
      predictor_(make_predictor(rules_)) {
  if (config.channel_server.propagation.model == channel_server::PropagationModel::kRays)
    rays_.emplace(water_.waters, water_.seabed, rays_of(config.channel_server, sources));
  place_vehicles(config);
}

void LinkSurveyor::place_vehicles(const ScenarioConfig& config) {
  const SimTime before = SimTime() - channel_server::kLongestFlight;
  for (const bus::VehicleEntry& vehicle : config.scenario.vehicles) {
    fleet_.reserve(vehicle.name, vehicle.id);
    const std::string problem =
        fleet_.add_state(vehicle.name, vehicle.id, {before, config.scenario.start_ned_m(vehicle)});
    require(problem.empty(), vehicle.name + ": " + problem);
  }
}

template <class IsReady>
void LinkSurveyor::wait_for_terrain(const IsReady& is_ready) {
  while (!is_ready()) answer_requests(*terrain_, *water_.seabed);
}

LinkSurveyor::Answer LinkSurveyor::survey(const LinkEnd& from, const LinkEnd& to) {
  channel_server::EndPair link{from, to};
  channel_server::NoiseOfLinks noise(noise_, SimTime());
  wait_for_terrain([&] {
    const bool is_noise_ready = noise.are_ready({link});  // first, so that all depths are requested together
    return propagation().is_ready(SimTime(), from, to) && is_noise_ready;
  });
  noise.set(link);
  return forecast(link.from, link.to, propagation().reception(SimTime(), link.from, link.to));
}

LinkSurveyor::Answer LinkSurveyor::survey(const LinkEnd& from, const LinkEnd& to, const Seabed& seabed,
                                          channel_server::SharedLine* line) {
  channel_server::EndPair link{from, to};
  channel_server::NoiseOfLinks noise(noise_, SimTime());
  wait_for_terrain([&] { return noise.are_ready({link}); });
  noise.set(link);
  return forecast(link.from, link.to,
                  rays_ ? rays_->reception_over(SimTime(), link.from, link.to, seabed, line)
                        : propagation().reception_without_capacity(SimTime(), link.from, link.to));
}

Decibels LinkSurveyor::noise_level(const acoustics::Modem& transmitter) {
  const acoustics::Band band = transmitter.band();
  return noise_level_over_band(band.low_hz, band.high_hz, propagation().environment(SimTime()).noise);
}

LinkSurveyor::Answer LinkSurveyor::forecast(const LinkEnd& from, const LinkEnd& to,
                                            channel_server::Reception reception) {
  Answer answer;
  answer.reception = std::move(reception);
  answer.forecast =
      predictor_.forecast(*predictor_.rates_of(*from.modem), *from.modem, *to.modem, answer.reception);
  return answer;
}

}  // namespace halocline::clients
