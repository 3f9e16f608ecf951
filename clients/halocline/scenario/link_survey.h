// SPDX-License-Identifier: BSD-3-Clause
// One link of a scenario between two points, computed here and now: budget, paths, and whether the bottom
// sends echoes.
//
// The same computation as that of the scenario's channel server (link_surveyor.h), with echo_survey.h over
// the scenario's terrain where sound goes straight.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "channel_server/links/echo_survey.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_table.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "clients/halocline/arrivals/arrival_output.h"
#include "clients/halocline/scenario/composition.h"
#include "core/frames.h"

namespace halocline::clients {

struct LinkSurveyEnd {
  std::string name;                  // of the vehicle, or the position as text
  channel_server::VehicleId id = 0;  // of the vehicle; 0: a position
  Vec3 position_ned_m = Vec3::Zero();
  Vec3 velocity_ned_mps = Vec3::Zero();  // for Doppler alone
  channel_server::VehicleModem modem;
};

struct LinkSurvey {
  channel_server::Reception reception;
  channel_server::LinkForecast forecast;
  channel_server::Multipath multipath = channel_server::Multipath::kUnknown;
  LinkArrivals arrivals;           // the paths of the reception with all that is known of them
  std::vector<std::string> notes;  // formulas taken beyond the range they were published for
};

// An end by the name of a vehicle of the scenario (where it starts, with its modem) or by "north,east,down"
// in metres (with the standard modem). Throws InvalidArgument when `text` is neither, or lies above the
// surface.
LinkSurveyEnd link_end(const ScenarioConfig& config, const std::string& text);

// "1,2,3" as three numbers; throws InvalidArgument, naming `what`, when `text` is something else.
Vec3 parse_vector(const std::string& text, const std::string& what);

// Throws InvalidArgument when an end lies inside the seabed. A straight path goes through terrain, as in a
// run: a note says so.
LinkSurvey survey_link(const ScenarioConfig& config, const LinkSurveyEnd& from, const LinkSurveyEnd& to);

// z of the seabed under a place, m: the last known depth where the terrain ends or has no data, as sound
// meets it. Empty for a place that is not finite.
std::optional<double> seabed_z_m(const bathymetry::Terrain& terrain, const Vec3& place_ned_m);

// Whether the terrain stands in the straight line between two points; false where it is not known.
bool is_cut(const bathymetry::Terrain& terrain, const Vec3& from_ned_m, const Vec3& to_ned_m);

// Throws InvalidArgument where the end lies inside the seabed.
void require_above_seabed(const bathymetry::Terrain& terrain, const LinkSurveyEnd& end);

// Which echoes the bottom can send between two points of a terrain.
channel_server::EchoSurvey survey_echoes(const bathymetry::Terrain& terrain, const Vec3& from_ned_m,
                                         const Vec3& to_ned_m, int bottom_points);

// Answers what the map has requested.
void answer_requests(const bathymetry::Terrain& terrain, channel_server::SeabedMap& seabed);

}  // namespace halocline::clients
