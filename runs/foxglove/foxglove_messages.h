// SPDX-License-Identifier: BSD-3-Clause
// Messages of a run in Foxglove's schemas: its scene, positions on the earth, and a log of the packets'
// outcomes.
//
// The frame "world" is east, north, up in metres from the scenario's origin, as Foxglove's panels expect.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "bathymetry/terrain/local_frame.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/run_timeline.h"
#include "runs/timeline/vehicle_record.h"

namespace halocline::clients {

nlohmann::json foxglove_time(SimTime at);

// Returns a foxglove.SceneUpdate: vehicles with their names, links coloured by SNR, and the wavefronts of
// those of `packets` that are under way.
nlohmann::json foxglove_scene(const RunTimeline& timeline, SimTime at,
                              std::span<const PacketRecord* const> packets);

// Returns the simulator's default transformation between the earth and the scenario's frame; nothing when the
// origin is unknown.
std::optional<bathymetry::LocalFrame> frame_of(const RunTimeline& timeline);

// Position in WGS84; the height is above the datum of depths, positive up.
struct PlaceOnEarth {
  double latitude_deg = 0, longitude_deg = 0, height_m = 0;
};
PlaceOnEarth place_of(const bathymetry::LocalFrame& frame, const Vec3& position_ned_m);

// Returns a foxglove.LocationFix; null before the first state.
nlohmann::json foxglove_fix(const VehicleRecord& vehicle, const bathymetry::LocalFrame& frame, SimTime at);

nlohmann::json foxglove_log(SimTime at, bool is_loss, const std::string& name, const std::string& message);
nlohmann::json foxglove_log_of(const RunTimeline& timeline, const packet_outcome_t& outcome);

}  // namespace halocline::clients
