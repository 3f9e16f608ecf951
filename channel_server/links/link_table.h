// SPDX-License-Identifier: BSD-3-Clause
// The link tables of one instant: the quality of the link from each vehicle present to each other vehicle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "acoustics/link/least_loss.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/modem/modem.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/receiver_noise.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/for_each.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// Returns the verdict of a reception. Among rays, a path that bounced off the bottom above the cut-off is an
// echo; beside a straight path the verdict is Reception::bottom_echo.
Multipath multipath_of(const Reception& reception, Decibels cutoff);

// The quality of one link, as a link table or the answer to a link query states it.
struct LinkRow {
  VehicleId transmitter_id = 0;  // 0 for a position that holds no vehicle
  VehicleId receiver_id = 0;     // 0 for a position that holds no vehicle
  acoustics::LinkBudget budget;
  Multipath multipath = Multipath::kUnknown;
  SimDuration transmitter_age, receiver_age;  // ages of the states used
  PathState state = PathState::kOpen;
  PropagationUsed used = PropagationUsed::kStraight;
  std::int32_t path_count = 0;        // without diffuse paths
  Decibels diffuse_level = kSilence;  // copied from Reception
  SimDuration paths_age;              // copied from Reception
  double delay_spread_s = 0;
  double doppler_factor = 1;  // on the first significant path; 1 without a path

  LinkForecast forecast;

  // Copies budget, paths and forecast into the row.
  void set(const Reception& reception, const LinkForecast& predicted);
};

// The links from one transmitter to all receivers within its range.
struct LinkTable {
  VehicleId vehicle_id = 0;                      // the transmitter of every row
  std::vector<LinkRow> rows;                     // sorted by receiver id
  double range_m = acoustics::kMaxBoundedRange;  // beyond it there are no rows
  std::size_t out_of_range = 0;                  // number of vehicles present without a row
};

// Return a vehicle as the propagation takes it; as a receiver with the modem that receives packets of
// `sender`.
LinkEnd link_end(const PlacedVehicle& vehicle);
LinkEnd receiving_end(const PlacedVehicle& vehicle, const acoustics::Modem& sender);

// The links that have rows: for each transmitter that a shard serves, those to receivers within its range.
// They are sorted by transmitter, then receiver, in the order of the vehicles.
struct TableRows {
  struct Transmitter {
    std::size_t vehicle;  // index into the vehicles
    double range_m;
    std::vector<std::size_t> receivers;  // indices into the vehicles
  };
  std::vector<Transmitter> transmitters;
  std::vector<EndPair> links;  // the links of all transmitters
};

// Returns the links that have rows. `ranges_m` holds the range of each vehicle, m
// (ReachModel::reception_ranges_m); when it is empty every vehicle has rows to every other.
TableRows table_rows(const std::vector<PlacedVehicle>& vehicles, const std::vector<double>& ranges_m = {},
                     Shard shard = {});

// Returns one table for each transmitter, for links whose sound leaves at `instant`; a vehicle without others
// has an empty table. `rows` holds links between `vehicles`, for which the propagation must be ready.
// `noise`, unless null, replaces the ambient noise of levels, capacity and forecasts.
std::vector<LinkTable> link_tables(SimTime instant, const std::vector<PlacedVehicle>& vehicles,
                                   const TableRows& rows, Propagation& propagation, LinkPredictor& predictor,
                                   const ForEach& for_each = one_after_the_other,
                                   NoiseOfLinks* noise = nullptr);

}  // namespace halocline::channel_server
