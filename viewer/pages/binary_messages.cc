// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/binary_messages.h"

#include <bit>
#include <cstring>
#include <type_traits>

#include "core/frames.h"
#include "runs/timeline/vehicle_record.h"

namespace halocline::monitor {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in memory");

template <class Number>
void put(std::string& bytes, std::type_identity_t<Number> number) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(Number));
  std::memcpy(bytes.data() + at, &number, sizeof(Number));
}

void put_float(std::string& bytes, double number) { put<float>(bytes, static_cast<float>(number)); }

constexpr std::uint16_t kStale = 1, kSafeState = 2, kOnSeabed = 4;

std::uint16_t flags_of(const clients::VehicleRecord& vehicle, const clients::TrackState& state, SimTime at) {
  unsigned flags = state.age > kStaleAfter ? kStale : 0;
  const auto* sensors = vehicle.sensors.at_or_before(at);
  if (sensors != nullptr && at - sensors->at <= kStaleAfter) {
    if (sensors->value.safe_state != 0) flags |= kSafeState;
    if (sensors->value.on_seabed != 0) flags |= kOnSeabed;
  }
  return static_cast<std::uint16_t>(flags);
}

}  // namespace

std::string vehicle_frame(const clients::RunTimeline& timeline, SimTime at) {
  constexpr std::size_t kCountAt = 2;
  std::string bytes;
  put<std::uint8_t>(bytes, 1);
  put<std::uint8_t>(bytes, 1);
  put<std::uint16_t>(bytes, 0);
  put<double>(bytes, at.seconds());
  std::uint16_t count = 0;
  for (const clients::VehicleRecord& vehicle : timeline.vehicles()) {
    const auto state = state_at(vehicle.track, at);
    if (!state || count == 0xFFFF) continue;
    ++count;
    const Vec3& place = state->point.position_ned_m;
    put<std::uint16_t>(bytes, static_cast<std::uint16_t>(vehicle.index));
    put<std::uint16_t>(bytes, flags_of(vehicle, *state, at));
    for (const double part :
         {place.x(), place.y(), place.z(), state->point.attitude.yaw, state->point.attitude.pitch,
          state->point.attitude.roll, state->point.speed_mps, timeline.seabed_m(place.x(), place.y())})
      put_float(bytes, part);
  }
  std::memcpy(bytes.data() + kCountAt, &count, sizeof count);
  return bytes;
}

std::string terrain_frame(const DepthGrid& grid, std::int64_t id) {
  std::string bytes;
  put<std::uint8_t>(bytes, 2);
  put<std::uint8_t>(bytes, 1);
  put<std::uint16_t>(bytes, grid.rows);
  put<std::uint16_t>(bytes, grid.columns);
  put<std::uint16_t>(bytes, static_cast<std::uint16_t>(id & 0xFFFF));
  for (const double part : {grid.south_m, grid.west_m, grid.spacing_m}) put_float(bytes, part);
  for (const float depth_m : grid.depth_m) put<float>(bytes, depth_m);
  return bytes;
}

std::string link_frame(std::uint16_t column, SimTime at, const std::vector<LinkValue>& values) {
  std::string bytes;
  put<std::uint8_t>(bytes, 3);
  put<std::uint8_t>(bytes, 1);
  put<std::uint16_t>(bytes, column);
  put<std::uint32_t>(bytes, static_cast<std::uint32_t>(values.size()));
  put<double>(bytes, at.seconds());
  for (const LinkValue& value : values) {
    put<std::uint16_t>(bytes, value.from);
    put<std::uint16_t>(bytes, value.to);
    put<float>(bytes, value.value);
  }
  return bytes;
}

}  // namespace halocline::monitor
