// SPDX-License-Identifier: BSD-3-Clause
// Survey of one link of a scenario between two points: link budget, paths, and whether the bottom sends
// echoes.
//
// The computation is that of the scenario's channel server (link_surveyor.h).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "channel_server/links/link_predictor.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/frames.h"
#include "simulation/arrivals/arrival_output.h"
#include "simulation/composition.h"

namespace halocline::clients {

// End of a link: a vehicle of the scenario, or a position.
struct LinkSurveyEnd {
  std::string name;                  // the vehicle, or the position as text
  channel_server::VehicleId id = 0;  // 0: a position
  Vec3 position_ned_m = Vec3::Zero();
  Vec3 velocity_ned_mps = Vec3::Zero();  // used for Doppler only
  channel_server::VehicleModem modem;
};

struct LinkSurvey {
  channel_server::Reception reception;
  channel_server::LinkForecast forecast;
  channel_server::Multipath multipath = channel_server::Multipath::kUnknown;
  LinkArrivals arrivals;           // paths of the reception with all details
  std::vector<std::string> notes;  // formulas beyond their published range, and other remarks
  std::string noise_place;         // noise_place_text()
};

// Parses one end of a link: the name of a vehicle of the scenario (at its start, with its modem), or
// "north,east,down" in metres (with the standard modem). Throws InvalidArgument when `text` is neither, or
// when the position is above the surface.
LinkSurveyEnd link_end(const ScenarioConfig& config, const std::string& text);

// Parses "1,2,3" as three numbers; throws InvalidArgument that names `what` when `text` is anything else.
Vec3 parse_vector(const std::string& text, const std::string& what);

// Returns the ends as the channel server sees them; they refer to the modems of `from` and `to`, which must
// outlive them.
channel_server::EndPair ends_between(const LinkSurveyEnd& from, const LinkSurveyEnd& to);

// Returns the depth of the water under the middle between two places, m; infinity where it is not known.
double water_depth_m(const ScenarioConfig& config, const bathymetry::Terrain& terrain, const Vec3& one_ned_m,
                     const Vec3& other_ned_m);

// Computes the link at simulation time 0. Throws InvalidArgument when an end is inside the seabed. A straight
// path passes through terrain, as in a run: a note says so.
LinkSurvey survey_link(const ScenarioConfig& config, const LinkSurveyEnd& from, const LinkSurveyEnd& to);

// Returns z of the seabed below a place, m. Beyond the terrain and where it has no data this is the last
// known depth, as sound uses it. Empty for a position that is not finite.
std::optional<double> seabed_z_m(const bathymetry::Terrain& terrain, const Vec3& place_ned_m);

// Throws InvalidArgument when the end is inside the seabed.
void require_above_seabed(const bathymetry::Terrain& terrain, const LinkSurveyEnd& end);

// Returns the place whose noise the scenario adds, and its spread: "shelf, +-6 dB from place to place". Empty
// where nothing is added.
std::string noise_place_text(const ScenarioConfig& config);

// Answers the map's pending requests for depths from the terrain.
void answer_requests(const bathymetry::Terrain& terrain, channel_server::SeabedMap& seabed);

}  // namespace halocline::clients
