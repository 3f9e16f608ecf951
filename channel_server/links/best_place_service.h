// SPDX-License-Identifier: BSD-3-Clause
// A service that finds the place from which several vehicles (the listeners) best receive a vehicle (the
// talker).
//
// Each place and listener form a link, from the talker's modem at rest at the place to the listener at its
// position at the requested time. The score of a place is the delivery probability of link_predictor.h,
// averaged over the listeners. Equal scores are ordered by mean SINR, which distinguishes places where
// everything or nothing is delivered. Places above the surface, inside the seabed or beyond 1e7 m score 0 and
// kSilence. All links are computed together, shared out among threads, with all the eigenray searches that
// packets have. A reply waits for the seabed for at most `timeout` of steady time, then takes the straight
// path.
//
// The noise at a listener is its own and that of all other vehicles except the talker, whose propeller is
// taken as at rest. Not modelled: interference, and reception at the place from the listeners. Not
// thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "channel_server/links/link_predictor.h"
#include "channel_server/links/receiver_noise.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// A query for the best of several places for a talker.
struct BestPlaceQuery {
  std::string client;
  std::int64_t request_id = 0;
  std::optional<SimTime> at;  // empty: the simulation time at which the query is received
  std::string talker;         // name of a vehicle; empty: a standard modem
  std::vector<Vec3> places_ned_m;
  std::vector<std::string> listeners;  // names of vehicles
};

// The score of one place: delivery probability over its listeners, mean and least, and mean SINR.
struct PlaceScore {
  double mean_delivery = 0, least_delivery = 0;
  double mean_sinr_db = kSilence.value;
  bool in_water = false;
};

// Returns the index of the best place in the water, the first of equals; empty when no place is in the water.
std::optional<std::size_t> best_of(const std::vector<PlaceScore>& scores);

// The reply to a query: the score of each place, or a refusal.
struct BestPlaceReply {
  std::string client;
  std::int64_t request_id = 0;
  SimTime at;                      // simulation time of the scores
  std::string refusal;             // not empty: the query is refused and there are no scores
  std::vector<PlaceScore> scores;  // in the order of the places
};

class BestPlaceService {
 public:
  static constexpr std::size_t kMaxLinks = 1600;  // places times listeners of a query
  static constexpr std::size_t kMaxWaiting = 16;  // queries that wait for the terrain
  // Largest difference between the requested time and the simulation time at which the query is received; a
  // query beyond it is answered for the nearest allowed time.
  static constexpr SimDuration kMaxTimeOffset = SimDuration::from_milliseconds(1000);

  // The references must outlive the service.
  BestPlaceService(const VehicleRegistry& fleet, Propagation& propagation, LinkPredictor& predictor,
                   ReceiverNoise& noise, SimDuration timeout, ForEach for_each);

  // Takes a query. A repetition of a query that is still waiting changes nothing. `sim` is empty while the
  // simulation time is unknown.
  void submit(const BestPlaceQuery& query, std::optional<SimTime> sim, SimTime steady);
  // Returns the replies that are complete at `steady` or whose deadline has passed.
  std::vector<BestPlaceReply> take_replies(SimTime steady);
  SimTime due() const;

 private:
  struct Listener {
    LinkEnd end;  // modem is null, see links_of()
    VehicleModem modem;
  };
  struct Waiting {
    BestPlaceReply reply;
    VehicleId talker_id = 0;
    VehicleModem talker;
    std::vector<Vec3> places_ned_m;
    std::vector<Listener> listeners;
    SimTime deadline;
  };
  [[nodiscard]] std::string refusal_of(const BestPlaceQuery& query, std::optional<SimTime> sim) const;
  // Resolves talker and listeners into `waiting`; returns why they cannot be resolved, or empty.
  [[nodiscard]] std::string resolve(const BestPlaceQuery& query, Waiting& waiting) const;
  // Computes the scores. Returns false while the seabed is awaited and the deadline has not passed.
  [[nodiscard]] bool answer(Waiting& waiting, bool is_overdue);
  bool is_in_water(const Vec3& place_ned_m, SimTime at) const;
  // Returns the links of all places in the water, place by place, each with all listeners.
  std::vector<EndPair> links_of(const Waiting& waiting, const std::vector<bool>& in_water) const;

  const VehicleRegistry& fleet_;
  Propagation& propagation_;
  LinkPredictor& predictor_;
  ReceiverNoise& noise_;
  SimDuration timeout_;
  ForEach for_each_;
  std::deque<Waiting> waiting_;
};

}  // namespace halocline::channel_server
