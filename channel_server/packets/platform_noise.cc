// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/platform_noise.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "acoustics/fading/link_fading.h"
#include "acoustics/link/least_loss.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

// The waveform family of vehicle noise, which no modem receives.
constexpr const char* kNoiseFamily = "vehicle-noise";

NoiseQuery noise_query_of(const Flight& flight, SimTime decided_at) {
  return {{flight.receiver_id, flight.place.position_ned_m, flight.place.velocity_ned_mps, &flight.modem},
          flight.packet->modem.band(),
          flight.arrival(),
          decided_at};
}

}  // namespace

// Returns the propeller rate, turns a second, or the speed over ground, m/s, that drives the noise.
double PlatformNoise::speed_of(const NoiseSource& noise, SimTime at, SimTime decided_at) const {
  if (noise.driver == NoiseDriver::kPropeller)
    return fleet_.equipment().noise.rate_at(noise.id, at, decided_at);
  const auto place = fleet_.placement(noise.id, at, decided_at);
  return place ? place->velocity_ned_mps.norm() : 0;
}

double PlatformNoise::own_power(VehicleId receiver, const acoustics::Band& band, SimTime at,
                                SimTime decided_at) const {
  const auto& sources = fleet_.equipment().noise.sources();
  const auto own = sources.find(receiver);
  if (own == sources.end()) return 0;
  return to_power_ratio(-own->second.own_loss).value *
         noise_power_at_1m(own->second, speed_of(own->second, at, decided_at), band.low_hz, band.high_hz);
}

// Returns null when the vehicle has no position or makes no noise.
PacketPointer PlatformNoise::sound_of(const NoiseSource& noise, const NoiseQuery& query) const {
  const auto& [receiver, band, at, decided_at, silent] = query;
  const auto now = fleet_.placement(noise.id, at, decided_at);
  if (!now) return nullptr;
  const Vec3& to = receiver.position_ned_m;
  const double speed_mps = sound_speed_at(propagation_.environment(at), to);
  const SimTime left = at - SimDuration::from_seconds((now->position_ned_m - to).norm() / speed_mps);
  const auto place = fleet_.placement(noise.id, left, decided_at);
  const double power = noise_power_at_1m(noise, speed_of(noise, left, decided_at), band.low_hz, band.high_hz);
  if (!place || power <= 0) return nullptr;
  Packet sound;
  sound.request.vehicle = noise.vehicle;
  sound.request.source_id = noise.id;
  sound.is_noise = true;
  sound.departure = left;
  sound.departure_ned_m = place->position_ned_m;
  sound.velocity_ned_mps = place->velocity_ned_mps;
  sound.modem.family = kNoiseFamily;
  sound.modem.centre_frequency_hz = band.centre_hz();
  sound.modem.bandwidth_hz = band.width_hz();
  sound.modem.source_level = to_decibels({power});
  return std::make_shared<const Packet>(std::move(sound));
}

std::vector<PacketPointer> PlatformNoise::sounds_within_reach(const NoiseQuery& query) {
  if (!any_is_heard()) return {};
  std::vector<PlacedVehicle> present;
  if (reach_ != nullptr) present = place_all(fleet_, query.at);
  std::vector<PacketPointer> sounds;
  for (const auto& [id, noise] : fleet_.equipment().noise.sources()) {
    if (id == query.receiver.id || id == query.silent || !noise.is_heard_by_others) continue;
    PacketPointer sound = sound_of(noise, query);
    if (!sound) continue;
    const double range_m = (sound->departure_ned_m - query.receiver.position_ned_m).norm();
    const double reach_m = reach_ == nullptr
                               ? acoustics::kMaxBoundedRange
                               : reach_->reach_m(sound->departure, sound->modem, fleet_, present);
    if (range_m <= reach_m) sounds.push_back(std::move(sound));
  }
  return sounds;
}

bool PlatformNoise::is_ready(const NoiseQuery& query) {
  bool ready = true;  // asks for every sound, so that all missing paths are requested at once
  for (const PacketPointer& sound : sounds_within_reach(query)) {
    ready = propagation_.is_ready_for_packet(sound->departure, sound->link_end(), query.receiver) && ready;
  }
  return ready;
}

bool PlatformNoise::are_ready(const Flight& flight, SimTime decided_at) {
  return is_ready(noise_query_of(flight, decided_at));
}

std::vector<NoiseSound> PlatformNoise::others(const NoiseQuery& query) {
  std::vector<NoiseSound> heard;
  for (PacketPointer& sound : sounds_within_reach(query)) {
    const Reception reception =
        propagation_.reception_without_capacity(sound->departure, sound->link_end(), query.receiver);
    if (reception.paths.empty()) continue;
    heard.push_back({std::move(sound), to_power_ratio(reception.budget.received_level).value});
  }
  return heard;
}

Decibels PlatformNoise::noise_level(VehicleId receiver, const acoustics::Band& band, SimTime at,
                                    SimTime decided_at) {
  Decibels level = ambient_.level(band, propagation_.environment(at).noise);
  if (variation_.changes_level()) level = level + noise_offset(variation_, seed_, at);
  const double own = own_power(receiver, band, at, decided_at);
  return own > 0 ? to_decibels({to_power_ratio(level).value + own}) : level;
}

Decibels PlatformNoise::mean_level(const NoiseQuery& query) {
  const Decibels own = noise_level(query.receiver.id, query.band, query.at, query.decided_at);
  double power = 0;
  for (const NoiseSound& sound : others(query)) power += sound.power;
  return power > 0 ? to_decibels({to_power_ratio(own).value + power}) : own;
}

Decibels PlatformNoise::above_ambient(const NoiseQuery& query) {
  return mean_level(query) - ambient_.level(query.band, propagation_.environment(query.at).noise);
}

void PlatformNoise::set_noise(Flight& flight, SimTime decided_at) {
  flight.reception.budget.noise_level =
      noise_level(flight.receiver_id, flight.packet->modem.band(), flight.arrival(), decided_at);
  if (!any_is_heard()) return;
  flight.noise = others(noise_query_of(flight, decided_at));
  for (NoiseSound& sound : flight.noise) {
    const VehicleId from = sound.source->request.source_id, to = flight.receiver_id;
    const acoustics::FadingLink link{seed_, static_cast<std::uint32_t>(std::min(from, to)),
                                     static_cast<std::uint32_t>(std::max(from, to)), from > to};
    const double large_scale = acoustics::LinkFading(fading_, link).large_scale(flight.sync_time());
    sound.power *= large_scale * large_scale;
  }
}

Interferers interferers_of(const Flight& flight, const ReceiverState& receiver, SimTime begin, SimTime end) {
  Interferers others = receiver.interferers_of(*flight.packet, begin, end);
  const double loss = to_power_ratio(flight.modem.receiver_loss).value;
  for (const NoiseSound& sound : flight.noise) {
    others.paths.push_back(
        {flight.signal.begin, flight.signal.end, loss * sound.power, others.packets.size()});
    others.packets.push_back(sound.source);
  }
  return others;
}

}  // namespace halocline::channel_server
