// SPDX-License-Identifier: BSD-3-Clause
// The sound between vehicles while a scenario runs, as `halocline waveform` finds it afterwards.
//
// Model: that of received_waveform.h, block by block. The paths of a sound on its way are searched every
// kFrame of its departure, with the ends where their latest STATEs have them; the same paths whatever the
// blocks are. Sampling rates of sender and receiver may differ: what lies above 0.45 of the receiver's rate
// is filtered away.
// Against received_waveform(): absorption over the band is by the way's length when the sound begins. Where
// STATEs come more seldom than every 0.1 s, a vehicle goes straight on from the last. Water is that of the
// scenario and its changes, not of SET_ENVIRONMENT.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "acoustics/waveform/analytic_signal.h"
#include "acoustics/waveform/moving_link.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "bus/bus.h"
#include "clients/halocline/analysis/recording.h"
#include "clients/halocline/scenario/composition.h"
#include "clients/halocline/waveform/scenario_links.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "core/sim_time.h"

namespace halocline::clients {

class LiveSea : public modem_gateway::SoundField {
 public:
  static constexpr SimDuration kLag = SimDuration::from_milliseconds(250);

  // Subscribes on the bus. `has_noise`: of the sea and of vehicles.
  LiveSea(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain, bus::Bus& bus,
          bool has_noise = true);

  void emit(std::int32_t vehicle_id, SimTime begin, double rate_hz, std::span<const float> samples) override;
  void silence(std::int32_t vehicle_id, SimTime from) override;
  SimDuration lag() const override { return kLag; }
  std::vector<double> record(std::int32_t vehicle_id, double rate_hz, std::int64_t first,
                             std::size_t count) override;

 private:
  // What left in a few frames, and its paths.
  struct Block {
    Way way;
    acoustics::AnalyticSignal sent;
    double sent_begin_s, last_arrival_s;
  };
  // A sound on its way to one receiver.
  struct SoundLink {
    LinkProgress progress;
    std::vector<double> taps;
    double next_arrival_s;  // of what leaves next, at the earliest
    std::deque<Block> blocks;
  };
  struct Sound {
    std::string vehicle;
    acoustics::Samples pressure;             // uPa at 1 m
    std::map<std::string, SoundLink> links;  // by receiver
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
  Recording run_;                              // the last of it
  std::set<std::string, std::less<>> placed_;  // vehicles whose STATE has come
  ScenarioLinks links_;
  std::deque<Sound> sounds_;
};

// For Composition.
modem_gateway::SoundFieldMaker live_sea_maker(const ScenarioConfig& config,
                                              const bathymetry::PreparedTerrain& terrain);

}  // namespace halocline::clients
