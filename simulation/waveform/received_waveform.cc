// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/waveform/received_waveform.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/check.h"
#include "simulation/waveform/recorded_noise.h"
#include "simulation/waveform/scenario_links.h"

namespace halocline::clients {

using acoustics::Samples;

Samples received_waveform(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain,
                          const Recording& run, const std::vector<SentWaveform>& sent,
                          const WaveformRules& rules) {
  require(!sent.empty(), "a waveform needs a sender");
  const double rate_hz = sent.front().sound.rate_hz;
  ScenarioLinks links(config, *terrain.terrain, run);
  std::vector<Way> ways;
  double end_s = rules.begin_s;
  for (const SentWaveform& wave : sent) {
    const auto& [begin_s, own_rate_hz, values] = wave.sound;
    require(own_rate_hz == rate_hz, "the waveforms of '" + sent.front().vehicle + "' and '" + wave.vehicle +
                                        "' have other sampling rates; allowed is one");
    require(wave.vehicle != rules.receiver, "'" + wave.vehicle + "' cannot receive its own waveform");
    const double sent_end_s = begin_s + static_cast<double>(values.size()) / rate_hz;
    ways.push_back(
        links.between(wave.vehicle, links.modem_of(wave.vehicle), rules.receiver, begin_s, sent_end_s));
    end_s = std::max(end_s, sent_end_s + ways.back().link.longest_delay_s());
  }
  Samples received{rules.begin_s, rate_hz, {}};
  received.values.resize(
      static_cast<std::size_t>(std::ceil((end_s + rules.tail_s - rules.begin_s) * rate_hz)));
  for (std::size_t i = 0; i < sent.size(); ++i) {
    Samples pressures = sent[i].sound;
    const double per_sample = std::numbers::sqrt2 * amplitude_of(sent[i].source_level);
    for (double& value : pressures.values) value *= per_sample;
    links.add_received(ways[i], pressures, received);
  }
  if (rules.has_noise) {
    add_sea_noise(config, links, rules.receiver, received);
    add_vehicle_noise(config, links, run, rules.receiver, received);
  }
  for (double& value : received.values) value *= amplitude_of(rules.sensitivity);
  return received;
}

}  // namespace halocline::clients
