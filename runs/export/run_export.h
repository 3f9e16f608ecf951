// SPDX-License-Identifier: BSD-3-Clause
// Export of a run to formats of other programs: MCAP for Foxglove and Lichtblick, GeoJSON and GPX for maps,
// netCDF for analysis.
//
// Instants are simulation time, written as if the run had begun on 1970-01-01 at 0:00 UTC.
#pragma once

#include <string>

#include "runs/timeline/run_timeline.h"

namespace halocline::clients {

// Sets the scenario's origin from "43.5,7.25", latitude and longitude in degrees. Throws InvalidArgument for
// any other text.
void set_origin(RunTimeline& timeline, const std::string& text);

// Every export replaces the file and throws std::runtime_error when it cannot be written.

// Writes MCAP with the topics /scene (2 per second, up to a minute after a message), /vehicles/NAME/position
// (each state, if there is an origin) and /log (outcomes and refusals).
void export_mcap(const RunTimeline& timeline, const std::string& path);

// Writes a line string for each vehicle, with heights in metres and the properties name, id and time_s. A
// line across the 180 degree meridian is cut there (date_line.h) into a MultiLineString, with a list of times
// for each piece. Throws InvalidArgument without an origin.
void export_geojson(const RunTimeline& timeline, const std::string& path);
// Writes a track for each vehicle. Throws InvalidArgument without an origin.
void export_gpx(const RunTimeline& timeline, const std::string& path);

// Writes trajectories after the CF conventions 1.8, section H.4.3 (contiguous ragged arrays): time, depth,
// latitude and longitude (if there is an origin), north, east, heading and speed.
void export_netcdf(const RunTimeline& timeline, const std::string& path);
// Type of the function that the module halocline_tracks_netcdf.so exports as halocline_write_tracks_netcdf.
using TracksWriter = void(const RunTimeline& timeline, const std::string& path);

}  // namespace halocline::clients
