// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/waveform/recorded_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "acoustics/modem/modem.h"
#include "acoustics/noise/noise_variation.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/noise.h"
#include "acoustics/waveform/shaped_noise.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_noise.h"
#include "core/random.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "simulation/vehicle_track.h"

namespace halocline::clients {
namespace {

using acoustics::Samples;
using channel_server::NoiseDriver;
using channel_server::NoiseSource;

using Weight = std::function<double(std::int64_t sample)>;

// Returns a factor that depends on time, evaluated once for each block of samples.
Weight in_blocks(double rate_hz, const std::function<double(SimTime)>& factor) {
  constexpr std::int64_t kBlock = 1024;
  return [=, known = std::map<std::int64_t, double>()](std::int64_t sample) mutable {
    const std::int64_t block = sample / kBlock;
    const auto [value, is_new] = known.try_emplace(block);
    if (is_new) value->second = factor(SimTime::from_seconds(static_cast<double>(block * kBlock) / rate_hz));
    return value->second;
  };
}

std::vector<double> samples_of(const acoustics::ShapedNoise& noise, const Samples& span,
                               const Weight& weight) {
  return noise.samples(std::llround(span.begin_s * span.rate_hz), span.values.size(), weight);
}

void add(const std::vector<double>& samples, Samples& sound) {
  std::transform(samples.begin(), samples.end(), sound.values.begin(), sound.values.begin(), std::plus<>());
}

// Adds the recorded turn rates of propellers.
void add_rates(const Recording& run, channel_server::VehicleNoise& noise) {
  for (const Recording::Event& event : run.events) {
    if (const auto* sensors = std::get_if<vehicle_sensors_t>(&event.message))
      noise.add_rate(event.channel.substr(event.channel.find('.') + 1), event.at,
                     channel_server::turn_rate_hz(*sensors));
  }
}

// Returns the amplitude of a vehicle's noise at an instant relative to its reference speed or turn rate.
// Noise power grows with the sixth power of the speed, so amplitude grows with the third:
//   a = (v / v_ref)^3
std::function<double(SimTime)> loudness_of(const NoiseSource& noise,
                                           const channel_server::VehicleNoise& rates,
                                           const VehicleTrack& track) {
  return [&noise, &rates, &track](SimTime at) {
    if (noise.driver == NoiseDriver::kNone) return 1.0;
    const double speed = noise.driver == NoiseDriver::kPropeller
                             ? rates.rate_at(noise.id, at, SimTime::never())
                             : track.at(at).velocity_ned_mps.norm();
    const double ratio = speed / noise.reference;
    return ratio * ratio * ratio;
  };
}

}  // namespace

void add_sea_noise(const ScenarioConfig& config, const ScenarioLinks& links, const std::string& receiver,
                   Samples& sound) {
  const auto who = static_cast<std::uint32_t>(links.id_of(receiver));
  const std::uint64_t seed = config.scenario.seed;
  const acoustics::NoiseVariation variation =
      channel_server::make_noise_variation(config.channel_server.environment, config.scenario);
  const acoustics::Environment& water = links.water(SimTime::from_seconds(sound.begin_s));
  const auto density = [&](double frequency_hz) {
    return acoustics::noise_power_density(frequency_hz, water.noise).value;
  };
  const auto noise_for = [&](const char* purpose) {
    return acoustics::ShapedNoise(density, sound.rate_hz,
                                  {.seed = seed, .purpose = purpose_of(purpose), .who = who});
  };
  const Weight louder =
      in_blocks(sound.rate_hz, [&](SimTime at) { return amplitude_of(noise_offset(variation, seed, at)); });
  add(samples_of(noise_for("waveform-noise"), sound, louder), sound);
  if (!variation.draws_bursts()) return;
  std::map<std::int64_t, double> bursts;
  const Weight bursting = [&](std::int64_t sample) {
    const double at_s = static_cast<double>(sample) / sound.rate_hz;
    const auto burst = static_cast<std::int64_t>(std::floor(at_s / variation.burst.seconds()));
    const auto [power, is_new] = bursts.try_emplace(burst);
    if (is_new) power->second = acoustics::burst_power(variation.burst_exponent, seed, who, burst);
    return louder(sample) * amplitude_of(variation.burst_level) * std::sqrt(power->second);
  };
  add(samples_of(noise_for("waveform-impulses"), sound, bursting), sound);
}

void add_vehicle_noise(const ScenarioConfig& config, ScenarioLinks& links, const Recording& run,
                       const std::string& receiver, Samples& sound) {
  channel_server::VehicleNoise noise =
      channel_server::make_equipment(config.channel_server, config.scenario).noise;
  add_rates(run, noise);
  const double end_s = sound.begin_s + static_cast<double>(sound.values.size()) / sound.rate_hz;
  for (const auto& [id, source] : noise.sources()) {
    const VehicleTrack track(run, source.vehicle);
    const acoustics::ShapedNoise spectrum(
        [&at_1m = source.at_1m](double f) { return to_power_ratio(at_1m.level(f)).value; }, sound.rate_hz,
        {.seed = config.scenario.seed,
         .purpose = purpose_of("waveform-vehicle"),
         .who = static_cast<std::uint32_t>(id)});
    const Weight louder = in_blocks(sound.rate_hz, loudness_of(source, noise, track));
    if (source.vehicle == receiver) {
      std::vector<double> own = samples_of(spectrum, sound, louder);
      for (double& value : own) value *= amplitude_of(-source.own_loss);
      add(own, sound);
      continue;
    }
    if (!source.is_heard_by_others) continue;
    // Sound that arrives within the span departed earlier by its travel time, at no less than 1400 m/s, and
    // by half a second for echoes.
    const SimTime begin = SimTime::from_seconds(sound.begin_s);
    const double range_m =
        (track.at(begin).position_ned_m - VehicleTrack(run, receiver).at(begin).position_ned_m).norm();
    Samples left{std::max(0.0, sound.begin_s - range_m / 1400 - 0.5), sound.rate_hz, {}};
    left.values.resize(static_cast<std::size_t>((end_s - left.begin_s) * sound.rate_hz));
    left.values = samples_of(spectrum, left, louder);
    acoustics::Modem of_noise;  // omnidirectional, in the receiver's band
    of_noise.centre_frequency_hz = links.modem_of(receiver).centre_frequency_hz;
    of_noise.bandwidth_hz = links.modem_of(receiver).bandwidth_hz;
    links.add_received(links.between(source.vehicle, of_noise, receiver, left.begin_s, end_s), left, sound);
  }
}

}  // namespace halocline::clients
