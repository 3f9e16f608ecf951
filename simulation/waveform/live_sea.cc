// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/waveform/live_sea.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <string_view>
#include <utility>

#include "acoustics/modem/modem.h"
#include "acoustics/waveform/linear_phase_filter.h"
#include "bus/messages/channels.h"
#include "bus/transport/subscription.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "core/check.h"
#include "simulation/vehicle_track.h"
#include "simulation/waveform/recorded_noise.h"

namespace halocline::clients {
namespace {

using acoustics::Samples;

// Number of frames in a block. Five frames are 0.1 s: with a STATE period of 0.1 s the receiver's position is
// known when the last of them arrives.
constexpr int kFrames = 5;
// Samples by which the filters of a block reach beyond either side of it: 512, 255 and 16.
constexpr std::ptrdiff_t kMargin = 1024;
// Upper bound on the shortening of the first path's delay within a block.
constexpr double kSooner_s = 0.005;
// Time for which states and sounds are kept: travel from 40 km away, with echoes.
constexpr SimDuration kKept = SimDuration::from_milliseconds(40'000);
constexpr double kPassband = 0.45;     // share of the receiver's sampling rate
constexpr double kFastest_mps = 1600;  // bound of sound speed plus closing speed, for the first block

}  // namespace

LiveSea::LiveSea(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain, bus::Bus& bus,
                 bool has_noise)
    : config_(config), terrain_(terrain), has_noise_(has_noise), links_(config_, *terrain_.terrain, run_) {
  bus.subscribe<vehicle_state_t>(
      bus::channels::kState,
      [this](std::string_view vehicle, const vehicle_state_t& state) {
        if (config_.scenario.find(vehicle) == nullptr) return;
        placed_.emplace(vehicle);
        keep(bus::channels::kState.of(std::string(vehicle)), state);
      },
      bus::Wakeup::kStoreOnly);
  if (channel_server::make_equipment(config_.channel_server, config_.scenario).noise.sources().empty())
    return;
  bus.subscribe<vehicle_sensors_t>(
      bus::channels::kSensors,
      [this](std::string_view vehicle, const vehicle_sensors_t& sensors) {
        keep(bus::channels::kSensors.of(std::string(vehicle)), sensors);
      },
      bus::Wakeup::kStoreOnly);
}

template <class Message>
void LiveSea::keep(std::string channel, const Message& message) {
  constexpr std::size_t kFew = 1000, kMax = 200'000;  // fewest and most events kept, for any time stamps
  auto& events = run_.events;
  const SimTime at = SimTime::from_utime(message.utime);
  events.push_back({at, std::move(channel), message});
  // Half of the events are dropped at a time, so that dropping is rare.
  const bool are_late = events[events.size() / 2].at + kKept < at;
  if (events.size() < kFew || (!are_late && events.size() < kMax)) return;
  events.erase(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(events.size() / 2));
}

std::string LiveSea::name_of(std::int32_t vehicle_id) const {
  for (const auto& vehicle : config_.scenario.vehicles) {
    if (vehicle.id == vehicle_id) return vehicle.name;
  }
  throw InvalidArgument("there is no vehicle " + std::to_string(vehicle_id));
}

void LiveSea::emit(std::int32_t vehicle_id, SimTime begin, double rate_hz, std::span<const float> samples) {
  Sound sound{name_of(vehicle_id), {begin.seconds(), rate_hz, {}}, {}};
  const double per_sample = std::numbers::sqrt2 * amplitude_of(links_.modem_of(sound.vehicle).source_level);
  sound.pressure.values.reserve(samples.size());
  for (const float sample : samples) sound.pressure.values.push_back(per_sample * double{sample});
  std::erase_if(sounds_,
                [&](const Sound& old) { return old.end_s() + kKept.seconds() < sound.pressure.begin_s; });
  sounds_.push_back(std::move(sound));
}

void LiveSea::silence(std::int32_t vehicle_id, SimTime from) {
  const std::string vehicle = name_of(vehicle_id);
  for (Sound& sound : sounds_) {
    auto& [begin_s, rate_hz, values] = sound.pressure;
    const double left = std::ceil((from.seconds() - begin_s) * rate_hz);
    if (sound.vehicle == vehicle && left < static_cast<double>(values.size()))
      values.resize(static_cast<std::size_t>(std::max(left, 0.0)));
  }
}

// Computes the paths of the link's next kFrames frames.
void LiveSea::add_block(const Sound& sound, SoundLink& link, double received_rate_hz) {
  const double begin_s = sound.pressure.begin_s, rate_hz = sound.pressure.rate_hz;
  const std::vector<double>& values = sound.pressure.values;
  const double from_s = link.progress.end_s();
  Way way = links_.extend(link.progress, link.progress.frames == 0 ? kFrames + 1 : kFrames);
  if (link.taps.empty())
    link.taps =
        links_.absorption_taps(way, SimTime::from_seconds(begin_s), rate_hz, kPassband * received_rate_hz);
  const auto index = [&](double at_s, std::ptrdiff_t beyond) {
    const auto n = static_cast<std::ptrdiff_t>(std::floor((at_s - begin_s) * rate_hz)) + beyond;
    return std::clamp<std::ptrdiff_t>(n, 0, std::ssize(values));
  };
  const std::ptrdiff_t first = index(from_s, -kMargin), last = index(link.progress.end_s(), kMargin);
  const std::vector<double> part(values.begin() + first, values.begin() + last);
  const double longest_s = way.link.longest_delay_s();
  link.next_arrival_s =
      link.progress.end_s() - kSooner_s +
      (link.progress.last.empty() ? link.progress.delay_s : link.progress.last.front().delay_s);
  link.blocks.push_back({std::move(way),
                         {rate_hz, acoustics::filtered(part, link.taps)},
                         begin_s + static_cast<double>(first) / rate_hz,
                         link.progress.end_s() + longest_s});
}

LiveSea::SoundLink& LiveSea::link_to(Sound& sound, const std::string& receiver) {
  const auto found = sound.links.find(receiver);
  if (found != sound.links.end()) return found->second;
  const double begin_s = sound.pressure.begin_s;
  const SimTime begin = SimTime::from_seconds(begin_s);
  const double range_m = (VehicleTrack(run_, sound.vehicle).at(begin).position_ned_m -
                          VehicleTrack(run_, receiver).at(begin).position_ned_m)
                             .norm();
  SoundLink link{{sound.vehicle, links_.modem_of(sound.vehicle), receiver, begin_s},
                 {},
                 begin_s + range_m / kFastest_mps,
                 {}};
  return sound.links.emplace(receiver, std::move(link)).first->second;
}

void LiveSea::add_sound(Sound& sound, const std::string& receiver, Samples& received) {
  const double end_s = received.begin_s + static_cast<double>(received.values.size()) / received.rate_hz;
  SoundLink& link = link_to(sound, receiver);
  // Interpolation by a sinc reaches 16 samples beyond the end of the sound, which is less than a frame.
  while (link.progress.end_s() < sound.end_s() + kFrame.seconds() && link.next_arrival_s < end_s)
    add_block(sound, link, received.rate_hz);
  while (!link.blocks.empty() && link.blocks.front().last_arrival_s < received.begin_s)
    link.blocks.pop_front();
  for (const Block& block : link.blocks)
    block.way.link.add_received(block.sent, block.sent_begin_s, received);
}

std::vector<double> LiveSea::record(std::int32_t vehicle_id, double rate_hz, std::int64_t first,
                                    std::size_t count) {
  const std::string receiver = name_of(vehicle_id);
  Samples received{static_cast<double>(first) / rate_hz, rate_hz, std::vector<double>(count)};
  if (!placed_.contains(receiver)) return received.values;
  for (Sound& sound : sounds_) {
    if (sound.vehicle != receiver && placed_.contains(sound.vehicle)) add_sound(sound, receiver, received);
  }
  if (has_noise_) {
    add_sea_noise(config_, links_, receiver, received);
    add_vehicle_noise(config_, links_, run_, receiver, received);
  }
  return received.values;
}

modem_gateway::SoundFieldMaker live_sea_maker(const ScenarioConfig& config,
                                              const bathymetry::PreparedTerrain& terrain) {
  return [config, terrain](bus::Bus& bus) { return std::make_unique<LiveSea>(config, terrain, bus); };
}

}  // namespace halocline::clients
