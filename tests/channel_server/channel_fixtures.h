// SPDX-License-Identifier: BSD-3-Clause
// Waters, modems and fleets that several tests of the channel server start from.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/state_history.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::channel_server::testing {

inline SimTime at_s(double seconds) { return SimTime::from_seconds(seconds); }
inline SimDuration for_s(double seconds) { return SimDuration::from_seconds(seconds); }

// The same speed everywhere, so that delays are range over speed.
inline constexpr double kSpeedMps = 1500;
inline acoustics::Environment even_water() {
  acoustics::Environment water;
  water.profile = acoustics::SoundSpeedProfile::isovelocity(kSpeedMps, {10, 35});
  return water;
}

// 8 bits take 10 ms, no overhead: durations are easy to read.
inline VehicleModem quick_modem() {
  VehicleModem modem;
  modem.modem.bit_rate_bps = 800;
  modem.max_payload_bytes = 64;
  return modem;
}

inline StampedState state_at(double time_s, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  return {at_s(time_s), position, velocity};
}

// Vehicle `id` is called "v<id>".
inline std::string name_of(VehicleId id) { return "v" + std::to_string(id); }

// States ten times a second over [begin, end], along a straight line.
inline void move_steadily(VehicleRegistry& fleet, VehicleId id, const Vec3& at_zero, const Vec3& velocity,
                          double begin_s, double end_s) {
  for (int tick = static_cast<int>(begin_s * 10); tick <= static_cast<int>(end_s * 10); ++tick) {
    const double time_s = tick / 10.0;
    EXPECT_EQ(fleet.add_state(name_of(id), id, state_at(time_s, at_zero + time_s * velocity, velocity)), "");
  }
}

inline SendRequest request_of(VehicleId source, double start_s, std::int64_t sequence,
                              std::size_t bytes = 1) {
  SendRequest request;
  request.vehicle = name_of(source);
  request.source_id = source;
  request.session = 7;
  request.packet_sequence = sequence;
  request.start = at_s(start_s);
  request.payload.assign(bytes, 0x5a);
  return request;
}

inline std::vector<Receipt> receipts_in(const std::vector<MediumEvent>& events) {
  std::vector<Receipt> receipts;
  for (const auto& event : events) {
    if (const auto* receipt = std::get_if<Receipt>(&event.what)) receipts.push_back(*receipt);
  }
  return receipts;
}

inline std::vector<PacketOutcome> outcomes_in(const std::vector<MediumEvent>& events) {
  std::vector<PacketOutcome> outcomes;
  for (const auto& event : events) {
    if (const auto* outcome = std::get_if<PacketOutcome>(&event.what)) outcomes.push_back(*outcome);
  }
  return outcomes;
}

// Answers what is missing of the seabed between two places: `depth_at(place)` metres.
template <class DepthAt>
void survey(SeabedMap& seabed, const Vec3& one, const Vec3& other, DepthAt depth_at) {
  while (!seabed.is_surveyed(one, other)) {
    for (TileSurvey& tile : seabed.take_requests()) {
      std::vector<RayAnswer> answers;
      for (const Vec3& point : tile.points_ned_m()) {
        answers.push_back({RayAnswer::Kind::kHit, static_cast<double>(depth_at(point))});
      }
      tile.take(answers);
      seabed.store(tile);
    }
  }
}

// The seabed around two places, `depth_at(north)` metres deep.
template <class DepthAt>
std::shared_ptr<SeabedMap> seabed_around(const Vec3& one, const Vec3& other, DepthAt depth_at) {
  auto seabed = std::make_shared<SeabedMap>(SeabedRule{});
  survey(*seabed, one, other, [&](const Vec3& place) { return depth_at(place.x()); });
  return seabed;
}

// Along rays, of the bottom known from 1 s on.
inline void expect_same_paths(const Reception& there, const Reception& back) {
  ASSERT_EQ(there.used, PropagationUsed::kRays);
  ASSERT_EQ(there.paths.size(), back.paths.size());
  for (std::size_t i = 0; i < there.paths.size(); ++i) {
    EXPECT_EQ(there.paths[i].delay_s, back.paths[i].delay_s);
    EXPECT_EQ(there.paths[i].level.value, back.paths[i].level.value);
    EXPECT_EQ(there.paths[i].launch_angle_rad, -back.paths[i].arrival_angle_rad);
  }
}

}  // namespace halocline::channel_server::testing
