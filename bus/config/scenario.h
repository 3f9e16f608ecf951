// SPDX-License-Identifier: BSD-3-Clause
// Part of a scenario file that every program of a run reads: name, seed, origin, time, and the vehicles.
//
// A scenario is one TOML file. Each program reads this part and its own sections; `halocline run` reads all
// sections, so that it finds every error at once. The sections are read by:
//   [scenario] [time] [bus] [ocean] [[tide]] [[vehicle]]               this file
//   [vehicle.battery]                                                  this file
//   [terrain]                                                          bathymetry/bathymetry_config.h
//   [environment] [water_load] [modem] [channel_server]                channel_server/channel_server_config.h
//   [vehicle.modem] [vehicle.clock] [vehicle.noise]                    channel_server/channel_server_config.h
//   [vehicle_sim] [sensors] [vehicle.sensors] [[tether]] [[fault]]     vehicle_sim/vehicle_sim_config.h
//   [vehicle.mission] [vehicle.traffic] [vehicle.localiser]            clients/
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bus/config/config.h"
#include "core/files/file_path.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/tide.h"

namespace halocline::bus {

// Battery of a vehicle. The vehicle simulator keeps its energy account; the channel server reports the energy
// of packets.
struct VehicleBattery {
  double capacity_j = 3.6e6;  // energy when full; 1 kWh is that of a REMUS 100
  double hotel_w = 20;        // power of all loads that are always on, except the modem; our choice
  double listening_w = 0.2;   // power of the idle modem, always drawn; Micromodem (Freitag et al. 2005)
  // Additional power while the modem receives a packet; that of a Micromodem's floating-point coprocessor.
  double receiving_w = 2;
  double transmit_efficiency = 0.5;  // acoustic over electric power of amplifier and transducer; our choice
  double shaft_efficiency = 0.7;     // shaft over electric power of motor and gear; our choice
  bool operator==(const VehicleBattery&) const = default;
};

// How a vehicle's modem is held below the sea surface.
enum class Mount {
  kFixed,     // at its depth: waves may leave it out of the water
  kFloating,  // follows the surface, tide included
};

// Vehicle data known to all programs.
struct VehicleEntry {
  std::string name;     // channel suffix (is_valid_name); unique
  std::int32_t id = 0;  // 1 and up; unique
  // Model that moves it: a model of the vehicle simulator, by name or as a file (docs/vehicles.md), "fixed"
  // (the vehicle simulator publishes a constant pose), or "external" (another process moves it).
  FilePath model = "torpedo";
  Vec3 start_ned_m = Vec3::Zero();  // world NED, m
  double heading_rad = 0;           // at the start, clockwise from north
  double speed_mps = 0;             // at the start, forward through the water
  Mount mount = Mount::kFixed;
  std::optional<VehicleBattery> battery = {};  // unlimited energy if not set
};

// Ocean fields that vary in space and time, from a file (ocean/ocean_field_reader.h).
struct OceanEntry {
  FilePath file;               // empty: none
  std::string start_date;      // date of simulation time 0; empty: the file's first time
  bool moves_vehicles = true;  // currents of the file act on vehicles
  bool carries_sound = true;   // temperature and salinity of the file give the sound speed
};

struct Scenario {
  std::string name = "unnamed";
  std::string description;
  std::uint64_t seed = 1;
  SimDuration duration = SimDuration::from_seconds(600);
  double origin_latitude_deg = 0;   // origin of the world frame, WGS 84
  double origin_longitude_deg = 0;  // -180 to 360
  bool origin_given = true;         // false: the file has no origin, and the values above are 0
  double sea_surface_z_m = 0;  // z of the surface in the world frame, m: negative if it lies above the datum
  Tide tide = {};              // about that z
  // Depth of the water of a terrain that is a shape, at its origin or far from its height, m; 0: a raster's.
  double water_depth_m = 0;
  double rate = 1;  // simulated seconds per wall second, for processes that keep pace with the wall clock
  SimDuration clock_period = SimDuration::from_milliseconds(100);  // between CLOCK messages, simulation time
  std::string accept;  // hosts whose datagrams are received (receive_filter.h)
  // Value of channel_server.state_lag_s: results that are later than this are late.
  SimDuration state_lag = SimDuration::from_milliseconds(50);
  // Side of the tiles with a multicast group each, m (tile_groups.h); 0: one group for all.
  double tile_m = 0;
  OceanEntry ocean;
  std::vector<VehicleEntry> vehicles;
  std::string configuration;  // configuration_of() its file, not a key; empty if there is none

  // Returns the z of the surface at a simulation time, m.
  double surface_z_m(double time_s) const { return sea_surface_z_m - tide.height_m(time_s); }
  // Returns where a vehicle starts: a floating one has its depth below the surface of that time, m.
  Vec3 start_ned_m(const VehicleEntry& vehicle) const;
  // Returns the vehicle of that name; null if the scenario has none.
  const VehicleEntry* find(std::string_view vehicle_name) const;
};

void visit(ConfigVisitor& v, Scenario& scenario);

// Returns the complete file with its overrides as TOML, and the files that it names, as every program of the
// run reads it. Keys that divide the work among programs (shards, blocks, threads) are left out.
std::string configuration_of(const ConfigFile& file);

}  // namespace halocline::bus
