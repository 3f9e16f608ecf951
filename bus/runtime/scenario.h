// SPDX-License-Identifier: BSD-3-Clause
// What every program of a run shares of a scenario file: name, seed, origin, time, and the vehicles.
//
// A scenario is one TOML file. Each program reads this part and the sections of its own; `halocline run`
// reads all, so that it finds every error at once. Sections and their owners:
//   [scenario] [time] [bus] [ocean] [[vehicle]] [vehicle.battery]    this file
//   [terrain]                          bathymetry/bathymetry_config.h
//   [environment] [modem] [channel_server], [vehicle.modem] [vehicle.clock] [vehicle.noise]
//   channel_server/channel_server_config.h [vehicle_sim] [sensors] [vehicle.sensors] [[tether]] [[fault]]
//   vehicle_sim/vehicle_sim_config.h [vehicle.mission] [vehicle.traffic] [vehicle.localiser]    clients/
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

namespace halocline::bus {

// What a vehicle lives on: the vehicle simulator keeps the account, the channel server says what packets
// take.
struct VehicleBattery {
  double capacity_j = 3.6e6;  // when full; 1 kWh is that of a REMUS 100
  double hotel_w = 20;        // of all that is always on, but the modem; our choice
  double listening_w = 0.2;   // of the modem, always; that of a Micromodem (Freitag et al. 2005)
  double receiving_w =
      2;  // more, while the modem follows a packet; a Micromodem's floating-point coprocessor
  double transmit_efficiency = 0.5;  // of amplifier and transducer: acoustic over electric power; our choice
  double shaft_efficiency = 0.7;     // of motor and gear: power of the shaft over electric power; our choice
  bool operator==(const VehicleBattery&) const = default;
};

// One vehicle, as all programs know it.
struct VehicleEntry {
  std::string name;     // channel suffix, is_valid_name; unique
  std::int32_t id = 0;  // 1 and up; unique
  // What moves it: a model of the vehicle simulator by name or as a file (docs/vehicles.md), "fixed" (the
  // vehicle simulator publishes a pose that never changes), or "external" (a process that is not ours).
  FilePath model = "torpedo";
  Vec3 start_ned_m = Vec3::Zero();             // world NED, metres
  double heading_rad = 0;                      // at the start, clockwise from north
  double speed_mps = 0;                        // at the start, forward through the water
  std::optional<VehicleBattery> battery = {};  // none: it has all the energy it needs
};

// The ocean as fields of place and time, from a file (ocean/ocean_field_reader.h).
struct OceanEntry {
  FilePath file;               // empty: none
  std::string start_date;      // of simulation time 0; empty: the file's first time
  bool moves_vehicles = true;  // its currents act on them
  bool carries_sound = true;   // sound goes through its temperature and salinity
  SimDuration sound_period =
      SimDuration::from_seconds(600);  // sound has the water of the middle of such a span
};

struct Scenario {
  std::string name = "unnamed";
  std::string description;
  std::uint64_t seed = 1;
  SimDuration duration = SimDuration::from_seconds(600);
  double origin_latitude_deg = 0;   // of the world frame, WGS 84
  double origin_longitude_deg = 0;  // -180 to 360
  bool origin_given = true;         // false: the file names none, and the above hold
  double sea_surface_z_m = 0;  // z of the surface in the world frame: negative when it lies above the datum
  double rate = 1;  // simulated seconds per wall second, for processes that keep pace with the wall
  SimDuration clock_period = SimDuration::from_milliseconds(100);  // between CLOCK messages, simulation time
  std::string accept;  // hosts whose datagrams are received (receive_filter.h)
  SimDuration state_lag =
      SimDuration::from_milliseconds(50);  // channel_server.state_lag_s: results later than this are late
  double tile_m = 0;  // of the tiles with a multicast group each (tile_groups.h); 0: one group for all
  OceanEntry ocean;
  std::vector<VehicleEntry> vehicles;
  std::string configuration;  // configuration_of() its file, no key of it; empty where there is none

  // The vehicle of that name; null when the scenario has none.
  const VehicleEntry* find(std::string_view vehicle_name) const;
};

void visit(ConfigVisitor& v, Scenario& scenario);

// The whole file with its overrides as TOML, and the files that it names, as every program of the run reads
// it; without the keys that share out the work (shards, blocks, threads), which are the programs' own.
std::string configuration_of(const ConfigFile& file);

}  // namespace halocline::bus
