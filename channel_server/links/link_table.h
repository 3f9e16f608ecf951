// SPDX-License-Identifier: BSD-3-Clause
// The link tables of an instant: the quality of the link from every vehicle present to every other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
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

class KeptRows;

// What is known of bottom echoes on a link.
enum class Multipath {
  kUnlikely,
  kLikely,   // an echo reaches the receiver above its cut-off
  kUnknown,  // the terrain is not known
};

// From the bounces of the paths: an echo is a path that met the bottom. Unknown of straight paths.
Multipath multipath_of(const Reception& reception, Decibels cutoff);

struct LinkRow {
  VehicleId transmitter_id = 0;  // 0 for a position that holds no vehicle
  VehicleId receiver_id = 0;     // likewise
  acoustics::LinkBudget budget;
  Multipath multipath = Multipath::kUnknown;
  SimDuration transmitter_age, receiver_age;  // of the states used
  PathState state = PathState::kOpen;
  PropagationUsed used = PropagationUsed::kStraight;
  std::int32_t path_count = 0;        // but those that are diffuse
  Decibels diffuse_level = kSilence;  // of Reception
  SimDuration paths_age;              // of Reception, and since the row was computed
  double delay_spread_s = 0;
  double doppler_factor = 1;  // of the first significant path; 1 without one

  LinkForecast forecast;

  // Takes over budget, paths and what they deliver.
  void set(const Reception& reception, const LinkForecast& predicted);
};

struct LinkTable {
  VehicleId vehicle_id = 0;                           // the transmitter of every row
  std::vector<LinkRow> rows;                          // by receiver id
  double range_m = acoustics::kGreatestBoundedRange;  // beyond it there are no rows
  std::size_t out_of_range = 0;                       // vehicles present without one
};

// As the propagation takes it; a receiver as which it receives packets of `sender`.
LinkEnd link_end(const PlacedVehicle& vehicle);
LinkEnd receiving_end(const PlacedVehicle& vehicle, const acoustics::Modem& sender);

// Which links have rows: of each transmitter that a shard serves those to receivers within its range,
// transmitter by transmitter, the receivers in the order of the vehicles.
struct TableRows {
  struct Transmitter {
    std::size_t vehicle;  // its index
    double range_m;
    std::vector<std::size_t> receivers;  // theirs
  };
  std::vector<Transmitter> transmitters;
  std::vector<EndPair> links;                   // of all of them
  std::vector<std::optional<LinkRow>> carried;  // of links whose rows hold on (kept_rows.h); empty: of none

  bool is_carried(std::size_t link) const { return !carried.empty() && carried[link]; }
  // Those that are not carried on.
  std::vector<EndPair> to_compute() const;
};

// `ranges_m`: of each vehicle, m (ReachModel::reception_ranges_m). Empty: everybody has rows to everybody.
TableRows table_rows(const std::vector<PlacedVehicle>& vehicles, const std::vector<double>& ranges_m = {},
                     Shard shard = {});

using MultipathFunction =
    std::function<Multipath(const PlacedVehicle& transmitter, const PlacedVehicle& receiver)>;

// One table a transmitter, of links whose sound leaves at `instant`; a vehicle alone has an empty one. The
// propagation is ready for the links of `rows` to compute; all are of `vehicles`. `multipath` is called where
// paths are straight by choice: rays hold the echoes of the bottom. `kept`, unless null, takes what is
// computed. `noise`, unless null, replaces the ambient noise of levels, capacity and forecasts.
std::vector<LinkTable> link_tables(SimTime instant, const std::vector<PlacedVehicle>& vehicles,
                                   const TableRows& rows, Propagation& propagation, LinkPredictor& predictor,
                                   const MultipathFunction& multipath,
                                   const ForEach& for_each = one_after_the_other, KeptRows* kept = nullptr,
                                   NoiseOfLinks* noise = nullptr);

}  // namespace halocline::channel_server
