// SPDX-License-Identifier: BSD-3-Clause
// A mission in formats of others: MCAP for Foxglove and Lichtblick, GeoJSON and GPX for maps, netCDF for
// science.
//
// Instants are simulation time, written as if the mission had begun on 1970-01-01 at 0:00 UTC.
#pragma once

#include <optional>
#include <string>

#include "clients/mission/mission_store.h"

namespace halocline::clients {

// "43.5,7.25": latitude and longitude in degrees, into the scenario. Throws InvalidArgument for another text.
void set_origin(MissionStore& mission, const std::string& text);

// All replace the file and throw std::runtime_error when it cannot be written.

// Topics /scene (2 a second, up to a minute after a message), /vehicles/NAME/position (each state; with an
// origin) and /log (outcomes and refusals).
void export_mcap(const MissionStore& mission, const std::string& path);

// A line string for each vehicle, heights in metres; properties: name, id, time_s. A line over the meridian
// of 180 degrees is cut there (date_line.h) into a MultiLineString, with a list of times for each piece.
// Throws InvalidArgument without an origin.
void export_geojson(const MissionStore& mission, const std::string& path);
// A track for each vehicle. Likewise.
void export_gpx(const MissionStore& mission, const std::string& path);

// Trajectories after the CF conventions 1.8, section H.4.3 (contiguous ragged arrays): time, depth, latitude
// and longitude (with an origin), north, east, heading and speed.
void export_netcdf(const MissionStore& mission, const std::string& path);
// What the module halocline_tracks_netcdf.so exports as halocline_write_tracks_netcdf.
using TracksWriter = void(const MissionStore& mission, const std::string& path);

}  // namespace halocline::clients
