#include "clients/halocline/waveform/received_waveform.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include <unistd.h>

#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/modem/modem.h"
#include "acoustics/noise/noise_variation.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/noise.h"
#include "acoustics/waveform/analytic_signal.h"
#include "acoustics/waveform/shaped_noise.h"
#include "bathymetry/terrain/terrain.h"
#include "bus/logs/log_reader.h"
#include "bus/runtime/scenario.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "channel_server/water_model.h"
#include "clients/halocline/scenario/embedded_run.h"
#include "clients/halocline/scenario/link_survey.h"
#include "clients/halocline/waveform/vehicle_track.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/random.h"

namespace halocline::clients {
namespace {

using acoustics::PathGain;
using acoustics::Samples;
using channel_server::LinkEnd;
using channel_server::Reception;

double amplitude_of(Decibels level) { return elementary::exp10(level.value / 20); }

// The links of a scenario as they are at any departure, every search anew: a cell that shares one would step.
class ScenarioLinks {
 public:
  ScenarioLinks(const ScenarioConfig& config, const bathymetry::Terrain& terrain, const Recording& run)
      : config_(with_own_searches(config)),
        run_(run),
        modems_(make_modems(config_.channel_server)),
        terrain_(terrain),
        water_(make_water_model(config_.channel_server, config_.scenario, config_.folder)) {}

  const acoustics::Environment& water(SimTime at) const { return water_.propagation->environment(at); }
  std::int32_t id_of(const std::string& vehicle) const {
    const bus::VehicleEntry* entry = config_.scenario.find(vehicle);
    require(entry != nullptr, "'" + vehicle + "' is no vehicle of the scenario");
    return entry->id;
  }
  const acoustics::Modem& modem_of(const std::string& vehicle) const { return modems_.of(vehicle).modem; }

  // The paths of what leaves from begin on, kFrame apart.
  acoustics::MovingLink between(const std::string& from, const std::string& to, double begin_s,
                                double end_s) {
    const VehicleTrack sender(run_, from), receiver(run_, to);
    const acoustics::FadingLink pair{
        config_.scenario.seed, static_cast<std::uint32_t>(std::min(id_of(from), id_of(to))),
        static_cast<std::uint32_t>(std::max(id_of(from), id_of(to))), id_of(from) > id_of(to)};
    const acoustics::LinkFading fading(config_.channel_server.propagation.fading, pair);
    std::vector<std::vector<PathGain>> frames;
    double delay_s = -1;
    const auto count = static_cast<int>(std::ceil((end_s - begin_s) / kFrame.seconds())) + 2;
    for (int k = 0; k < count; ++k) {
      const SimTime departure = SimTime::from_seconds(begin_s) + kFrame * k;
      const Reception reception = reception_of(departure, {id_of(from), modem_of(from), sender.at(departure)},
                                               {id_of(to), modem_of(to), {}}, receiver, delay_s);
      frames.push_back(gains_of(reception, fading, departure, modem_of(from)));
    }
    return {begin_s, kFrame.seconds(), std::move(frames)};
  }

 private:
  struct End {
    std::int32_t id;
    const acoustics::Modem& modem;
    VehicleTrack::Place place;
    LinkEnd link_end() const { return {id, place.position_ned_m, place.velocity_ned_mps, &modem}; }
  };

  static ScenarioConfig with_own_searches(ScenarioConfig config) {
    config.channel_server.propagation.reuse_distance_m = 0;
    return config;
  }

  // `delay_s`: of the departure before, below 0 of none; set to that of this one.
  Reception reception_of(SimTime departure, const End& from, End to, const VehicleTrack& receiver,
                         double& delay_s) {
    constexpr double kNear = 1500;  // m/s: for a first guess
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

  static std::vector<PathGain> gains_of(const Reception& reception, const acoustics::LinkFading& fading,
                                        SimTime departure, const acoustics::Modem& modem) {
    std::vector<PathGain> gains;
    if (reception.paths.empty()) return gains;
    const SimTime arrival = departure + SimDuration::from_seconds(reception.paths.front().delay_s);
    const auto pressures =
        fading.responses(reception.paths, modem.band(), arrival, {}, fading.large_scale(arrival));
    const double sent = amplitude_of(modem.source_level);
    for (std::size_t i = 0; i < reception.paths.size(); ++i) {
      const acoustics::SoundPath& path = reception.paths[i];
      gains.push_back({path.identity, path.delay_s, pressures[i] / sent, path.doppler_factor});
    }
    return gains;
  }

  ScenarioConfig config_;
  const Recording& run_;
  channel_server::ConfiguredModems modems_;
  const bathymetry::Terrain& terrain_;
  channel_server::WaterModel water_;
};

// Pressure, uPa.
void add_noise(const ScenarioConfig& config, const acoustics::Environment& water, std::int32_t receiver,
               Samples& sound) {
  const auto who = static_cast<std::uint32_t>(receiver);
  const std::uint64_t seed = config.scenario.seed;
  const acoustics::NoiseVariation& variation = config.channel_server.environment.noise_variation;
  const auto density = [&](double frequency_hz) {
    return acoustics::noise_power_density(frequency_hz, water.noise).value;
  };
  const auto time_of = [&](std::int64_t sample) { return static_cast<double>(sample) / sound.rate_hz; };
  constexpr std::int64_t kBlock = 1024;  // samples over which the slow variation stands still
  std::map<std::int64_t, double> slow, bursts;
  const auto louder = [&](std::int64_t sample) {
    const auto [factor, is_new] = slow.try_emplace(sample / kBlock);
    if (is_new)
      factor->second = amplitude_of(
          noise_offset(variation, seed, SimTime::from_seconds(time_of(sample / kBlock * kBlock))));
    return factor->second;
  };
  const auto first = static_cast<std::int64_t>(std::llround(sound.begin_s * sound.rate_hz));
  const auto add = [&](const char* purpose, const std::function<double(std::int64_t)>& weight) {
    const acoustics::ShapedNoise noise(density, sound.rate_hz,
                                       {.seed = seed, .purpose = purpose_of(purpose), .who = who});
    const std::vector<double> samples = noise.samples(first, sound.values.size(), weight);
    std::transform(samples.begin(), samples.end(), sound.values.begin(), sound.values.begin(), std::plus<>());
  };
  add("waveform-noise", louder);
  if (!variation.has_bursts()) return;
  add("waveform-impulses", [&](std::int64_t sample) {
    const auto burst = static_cast<std::int64_t>(std::floor(time_of(sample) / variation.burst.seconds()));
    const auto [power, is_new] = bursts.try_emplace(burst);
    if (is_new) power->second = acoustics::burst_power(variation.burst_exponent, seed, who, burst);
    return louder(sample) * amplitude_of(variation.burst_level) * std::sqrt(power->second);
  });
}

}  // namespace

Recording record_run(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain, SimTime end) {
  lcm::LCM lcm("memq://");
  Composition all(lcm, config, Composition::kRun, nullptr, terrain);
  EmbeddedRun run{.end = end,
                  .log_path = std::filesystem::temp_directory_path() /
                              ("halocline-waveform-" + std::to_string(getpid()) + ".lcm")};
  run.quiet = true;
  run.threads = all.threads();
  const std::unique_ptr<const std::string, void (*)(const std::string*)> removed(
      &run.log_path, [](const std::string* path) { std::filesystem::remove(*path); });
  run_embedded(all.nodes(), run);
  LogReader log(run.log_path);
  return read_recording(log, config.scenario);
}

Samples received_waveform(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain,
                          const Recording& run, const std::vector<SentWaveform>& sent,
                          const WaveformRules& rules) {
  require(!sent.empty(), "a waveform needs a sender");
  const double rate_hz = sent.front().sound.rate_hz;
  ScenarioLinks links(config, *terrain.terrain, run);
  std::vector<acoustics::MovingLink> ways;
  double end_s = rules.begin_s;
  for (const SentWaveform& wave : sent) {
    const auto& [begin_s, own_rate_hz, values] = wave.sound;
    require(own_rate_hz == rate_hz, "the waveforms of '" + sent.front().vehicle + "' and '" + wave.vehicle +
                                        "' have other sampling rates; allowed is one");
    require(wave.vehicle != rules.receiver, "'" + wave.vehicle + "' cannot receive its own waveform");
    const double sent_end_s = begin_s + static_cast<double>(values.size()) / rate_hz;
    ways.push_back(links.between(wave.vehicle, rules.receiver, begin_s, sent_end_s));
    end_s = std::max(end_s, sent_end_s + ways.back().longest_delay_s());
  }
  Samples received{rules.begin_s, rate_hz, {}};
  received.values.resize(
      static_cast<std::size_t>(std::ceil((end_s + rules.tail_s - rules.begin_s) * rate_hz)));
  for (std::size_t i = 0; i < sent.size(); ++i) {
    std::vector<double> pressures = sent[i].sound.values;
    const double per_sample = std::numbers::sqrt2 * amplitude_of(sent[i].source_level);
    for (double& value : pressures) value *= per_sample;
    ways[i].add_received({rate_hz, pressures}, sent[i].sound.begin_s, received);
  }
  if (rules.has_noise)
    add_noise(config, links.water(SimTime::from_seconds(rules.begin_s)), links.id_of(rules.receiver),
              received);
  for (double& value : received.values) value *= amplitude_of(rules.sensitivity);
  return received;
}

}  // namespace halocline::clients
