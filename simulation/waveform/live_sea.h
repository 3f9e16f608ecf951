// SPDX-License-Identifier: BSD-3-Clause
// Sound field between vehicles while a scenario runs, as `halocline waveform` computes it from a recording.
//
// Model: that of received_waveform.h, block by block. The paths of a sound are searched for every kFrame of
// its departure, with both ends at the positions of their latest STATEs; they do not depend on the division
// into blocks. Sender and receiver may have different sampling rates: frequencies above 0.45 of the
// receiver's rate are filtered out.
//
// Differences from received_waveform(): absorption over the band uses the path length at the beginning of the
// sound. When STATEs are more than 0.1 s apart, a vehicle is extrapolated along a straight line from the last
// one. The water is that of the scenario and its changes; SET_ENVIRONMENT is ignored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "acoustics/waveform/analytic_signal.h"
#include "acoustics/waveform/moving_link.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "bus/bus.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "core/sim_time.h"
#include "runs/analysis/recording.h"
#include "simulation/composition.h"
#include "simulation/waveform/scenario_links.h"

namespace halocline::clients {

// Sound field that modem interfaces use during a run. The sound at an instant is complete kLag after it.
class LiveSea : public modem_gateway::SoundField {
 public:
  static constexpr SimDuration kLag = SimDuration::from_milliseconds(250);

  // Subscribes on the bus. `has_noise` adds the noise of the sea and of vehicles.
  LiveSea(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain, bus::Bus& bus,
          bool has_noise = true);

  void emit(std::int32_t vehicle_id, SimTime begin, double rate_hz, std::span<const float> samples) override;
  void silence(std::int32_t vehicle_id, SimTime from) override;
  SimDuration lag() const override { return kLag; }
  std::vector<double> record(std::int32_t vehicle_id, double rate_hz, std::int64_t first,
                             std::size_t count) override;

 private:
  // Part of a sound that departs within a few frames, and its paths.
  struct Block {
    Way way;
    acoustics::AnalyticSignal sent;
    double sent_begin_s, last_arrival_s;
  };
  // Propagation of a sound to one receiver.
  struct SoundLink {
    LinkProgress progress;
    std::vector<double> taps;
    double next_arrival_s;  // earliest arrival of the next block
    std::deque<Block> blocks;
  };
  struct Sound {
    std::string vehicle;
    acoustics::Samples pressure;             // uPa at 1 m
    std::map<std::string, SoundLink> links;  // keyed by receiver
    double end_s() const {
      return pressure.begin_s + static_cast<double>(pressure.values.size()) / pressure.rate_hz;
    }
  };

  std::string name_of(std::int32_t vehicle_id) const;
  template <class Message>
  void keep(std::string channel, const Message& message);
  SoundLink& link_to(Sound& sound, const std::string& receiver);
  void add_block(const Sound& sound, SoundLink& link, double received_rate_hz);
  void add_sound(Sound& sound, const std::string& receiver, acoustics::Samples& received);

  ScenarioConfig config_;
  bathymetry::PreparedTerrain terrain_;
  bool has_noise_;
  Recording run_;                              // most recent messages only
  std::set<std::string, std::less<>> placed_;  // vehicles with a STATE
  ScenarioLinks links_;
  std::deque<Sound> sounds_;
};

// Returns the maker of this sound field for Composition.
modem_gateway::SoundFieldMaker live_sea_maker(const ScenarioConfig& config,
                                              const bathymetry::PreparedTerrain& terrain);

}  // namespace halocline::clients
