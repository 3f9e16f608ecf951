// SPDX-License-Identifier: BSD-3-Clause
// Answers link queries: between vehicles by name, and between positions and modems that need not exist.
//
// Every link is answered or refused on its own, with the noise of receiver_noise.h, of which a place that
// holds no vehicle has none of its own. A straight budget is computed at once; whether an echo is likely,
// and rays, need the terrain: a reply waits for it no longer than `timeout` of steady time, then holds
// unknown (and the straight path). Echoes are surveyed urgently, unless the link tables know those of the two
// vehicles; the bottom that rays need is requested by the propagation itself.
//
// The position of a named vehicle is that of state_history.h at the simulation time of the query; while no
// simulation time is known, no vehicle is. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_table.h"
#include "channel_server/links/multipath_cache.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/links/receiver_noise.h"
#include "channel_server/propagation/link_tracks.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/state_history.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

struct LinkEndRequest {
  std::string vehicle;                     // empty: the position
  Vec3 position_ned_m = Vec3::Zero();      // world NED, m
  std::optional<VehicleModem> modem = {};  // empty: the vehicle's own, or the standard one
  std::string problem = {};                // not empty: this end could not even be read
};

struct LinkQuery {
  std::string client;
  std::int64_t request_id = 0;
  std::vector<LinkEndRequest> transmitters, receivers;  // as many of each
  bool wants_paths = false;                             // of one link
};

struct LinkAnswer {
  enum class Status { kAnswered, kUnknownVehicle, kBadInput };
  Status status = Status::kAnswered;
  std::string problem;  // empty when answered
  LinkRow row;          // holds when answered
};

// How the sound of one link travels.
struct LinkDetails {
  Decibels source_level, directivity_index;  // of the transmitter, of the receiver
  LinkTracks tracks;
  std::vector<acoustics::SpeedRow> water;  // down to the seabed, or to the deeper end
};

struct LinkReply {
  std::string client;
  std::int64_t request_id = 0;
  SimTime at;                               // for which the answers hold; 0 while no simulation time is known
  std::string refusal;                      // not empty: the query as a whole is refused
  std::vector<LinkAnswer> answers;          // in the order of the query
  std::optional<LinkDetails> details = {};  // where the query wants paths and its link is answered
};

// Why a position is none in the sea, whatever the seabed; empty when it is one.
[[nodiscard]] std::string problem_of_place(const Propagation& propagation, const Vec3& position_ned_m,
                                           SimTime at);
// By so much the smooth seabed of rays may lie above that of the terrain, m: a place less far inside is taken
// as on it.
inline constexpr double kSeabedErrorM = 1;

class LinkQueryService {
 public:
  static constexpr std::size_t kMaxLinks = 200;   // of one query
  static constexpr std::size_t kMaxWaiting = 64;  // queries that wait for the terrain

  struct Rule {
    int bottom_points = 9;  // of an echo survey
    SimDuration timeout = SimDuration::from_milliseconds(250);
  };

  // All of them must outlive the service.
  LinkQueryService(const VehicleRegistry& fleet, Propagation& propagation, LinkPredictor& predictor,
                   ReceiverNoise& noise, MultipathCache& echoes, RayQueryClient& rays, Rule rule);

  // A repetition of a query that is still waiting changes nothing. `sim` is empty while unknown.
  void submit(const LinkQuery& query, std::optional<SimTime> sim, SimTime steady);
  // A survey has ended; true when it was one of this service's.
  [[nodiscard]] bool finish(const RayQueryClient::Finished& finished);
  // What is ready at `steady`, or has waited long enough.
  std::vector<LinkReply> take_replies(SimTime steady);
  // at_once() while a reply is ready.
  SimTime due() const;
  void clear();

 private:
  struct ResolvedEnd {
    LinkAnswer::Status status = LinkAnswer::Status::kAnswered;
    std::string problem;
    VehicleId id = 0;
    Placement placement;
    VehicleModem modem;
    PlacedVehicle placed() const { return {id, placement, &modem}; }  // valid as long as this end
  };
  struct Waiting {
    LinkReply reply;
    SimTime deadline;
    bool wants_paths = false;
    // What is waited for, by the index of the answer.
    std::map<RayQueryClient::SurveyId, std::size_t> surveys;
    std::set<std::size_t> bottoms;
    std::map<std::size_t, std::pair<ResolvedEnd, ResolvedEnd>> ends;
    bool is_done() const { return surveys.empty() && bottoms.empty(); }
  };
  [[nodiscard]] std::string refusal_of(const LinkQuery& query) const;
  ResolvedEnd resolve(const LinkEndRequest& end, std::optional<SimTime> sim) const;
  ResolvedEnd resolve_vehicle(const LinkEndRequest& end, std::optional<SimTime> sim) const;
  void answer(const ResolvedEnd& from, const ResolvedEnd& to, NoiseOfLinks& noise, Waiting& waiting);
  // Valid as long as both ends.
  static EndPair link_of(const ResolvedEnd& from, const ResolvedEnd& to);
  // Or why there can be none.
  void set_reception(const ResolvedEnd& from, const ResolvedEnd& to, SimTime at, NoiseOfLinks& noise,
                     LinkAnswer& answer);
  [[nodiscard]] std::string problem_with_seabed(const ResolvedEnd& end) const;
  void wait_for_terrain(const ResolvedEnd& from, const ResolvedEnd& to, Waiting& waiting);
  void take_bottoms(Waiting& waiting);
  void add_details(Waiting& waiting);

  const VehicleRegistry& fleet_;
  Propagation& propagation_;
  LinkPredictor& predictor_;
  ReceiverNoise& noise_;
  MultipathCache& echoes_;
  RayQueryClient& rays_;
  Rule rule_;
  std::deque<Waiting> waiting_;
};

}  // namespace halocline::channel_server
