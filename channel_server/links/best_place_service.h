// SPDX-License-Identifier: BSD-3-Clause
// Answers at which of some places a vehicle is best heard by others.
//
// Each place and listener is a link from the place, with the talker's modem at rest, to the listener where it
// is at the time asked for. A place is scored by the delivery probability of link_predictor.h, mean over the
// listeners; of equals the greater mean SINR is better, which tells places apart where everything or nothing
// is delivered. Places above the surface, inside the seabed or beyond 1e7 m score 0 and kSilence. Links are
// computed together, shared out among threads, with all the searches that packets have; a reply waits for the
// seabed no longer than `timeout` of steady time, then takes the straight path.
//
// Listeners hear their own noise and that of other vehicles but the talker, whose propeller is taken as at
// rest with it. Left out: interference, and how the listeners are heard at the place. Not thread-safe.
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

struct BestPlaceQuery {
  std::string client;
  std::int64_t request_id = 0;
  std::optional<SimTime> at;  // empty: when it is received
  std::string talker;         // a vehicle; empty: the standard modem
  std::vector<Vec3> places_ned_m;
  std::vector<std::string> listeners;  // vehicles
};

struct PlaceScore {
  double mean_delivery = 0, least_delivery = 0;
  double mean_sinr_db = kSilence.value;
  bool in_water = false;
};

// Index of the best; empty where none is in the water. Of equals the first.
std::optional<std::size_t> best_of(const std::vector<PlaceScore>& scores);

struct BestPlaceReply {
  std::string client;
  std::int64_t request_id = 0;
  SimTime at;                      // for which it holds
  std::string refusal;             // not empty: there are no scores
  std::vector<PlaceScore> scores;  // in the order of the places
};

class BestPlaceService {
 public:
  static constexpr std::size_t kMaxLinks = 1600;  // places times listeners of one query
  static constexpr std::size_t kMaxWaiting = 16;  // queries that wait for the terrain
  // A query may ask for an instant this far from the simulation time at which it is received; else it gets
  // the nearest such.
  static constexpr SimDuration kMostOff = SimDuration::from_milliseconds(1000);

  // All of them must outlive the service.
  BestPlaceService(const VehicleRegistry& fleet, Propagation& propagation, LinkPredictor& predictor,
                   ReceiverNoise& noise, SimDuration timeout, ForEach for_each);

  // A repetition of a query that is still waiting changes nothing. `sim` is empty while unknown.
  void submit(const BestPlaceQuery& query, std::optional<SimTime> sim, SimTime steady);
  // What is ready at `steady`, or has waited long enough.
  std::vector<BestPlaceReply> take_replies(SimTime steady);
  SimTime due() const;
  void clear() { waiting_.clear(); }

 private:
  struct Listener {
    LinkEnd end;  // without its modem
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
  // Why they cannot be; else they are in `waiting`.
  [[nodiscard]] std::string resolve(const BestPlaceQuery& query, Waiting& waiting) const;
  // False while the seabed is awaited, unless that is over.
  [[nodiscard]] bool answer(Waiting& waiting, bool is_overdue);
  bool is_in_water(const Vec3& place_ned_m, SimTime at) const;
  // Place by place, of those that are in the water.
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
