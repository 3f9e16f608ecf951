// SPDX-License-Identifier: BSD-3-Clause
// A service that answers link queries: between vehicles by name, and between arbitrary positions with given
// modems.
//
// Each link is answered or refused on its own. Its noise is that of receiver_noise.h; a position without a
// vehicle has no own noise. The budget of a straight path is computed at once. Whether an echo is likely, and
// rays, need the seabed, which the propagation requests: a reply waits for it for at most `timeout` of steady
// time, then states kUnknown and the straight path.
//
// The position of a named vehicle is the one predicted for the simulation time of the query
// (state_history.h). Every named vehicle is unknown while no simulation time is known. Not thread-safe.
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
#include "channel_server/links/receiver_noise.h"
#include "channel_server/propagation/link_chart.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/state_history.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// One end of a requested link: a vehicle by name, or a position with a modem.
struct LinkEndRequest {
  std::string vehicle;                     // empty: position_ned_m is used
  Vec3 position_ned_m = Vec3::Zero();      // world NED, m
  std::optional<VehicleModem> modem = {};  // empty: the vehicle's own; for a position the standard modem
  std::string problem = {};                // not empty: this end of the request could not be read
};

// A query for the links between pairs of ends.
struct LinkQuery {
  std::string client;
  std::int64_t request_id = 0;
  // Equally long: link i is from transmitter i to receiver i.
  std::vector<LinkEndRequest> transmitters, receivers;
  bool wants_paths = false;  // asks for the chart; only allowed with one link
};

// The answer for one link: its row, or why it has none.
struct LinkAnswer {
  enum class Status { kAnswered, kUnknownVehicle, kBadInput };
  Status status = Status::kAnswered;
  std::string problem;  // empty when answered
  LinkRow row;          // valid when answered
};

// The chart of one link, with the levels and the sound speed needed to draw them.
struct LinkDetails {
  Decibels source_level, directivity_index;  // the transmitter's and the receiver's
  LinkChart chart;
  std::vector<acoustics::SpeedRow> water;  // sound speed by depth, down to the seabed or the deeper end
};

// The reply to a query: an answer for each link, or a refusal of the whole.
struct LinkReply {
  std::string client;
  std::int64_t request_id = 0;
  SimTime at;                               // simulation time of the answers; 0 while none is known
  std::string refusal;                      // not empty: the whole query is refused
  std::vector<LinkAnswer> answers;          // in the order of the query
  std::optional<LinkDetails> details = {};  // set when the query wants paths and its link is answered
};

// Returns why a position is not in the sea, without regard to the seabed; empty when it is. A position must
// lie within 1e7 m of the origin along each axis and between the sea surface and 12000 m depth.
[[nodiscard]] std::string problem_of_place(const Propagation& propagation, const Vec3& position_ned_m,
                                           SimTime at);
// Tolerance of positions inside the seabed, m: the smooth seabed of rays may lie this far above the
// terrain's, so a position no further inside counts as on the seabed.
inline constexpr double kSeabedErrorM = 1;

class LinkQueryService {
 public:
  static constexpr std::size_t kMaxLinks = 200;   // links of one query
  static constexpr std::size_t kMaxWaiting = 64;  // queries that wait for the terrain

  // The references must outlive the service.
  LinkQueryService(const VehicleRegistry& fleet, Propagation& propagation, LinkPredictor& predictor,
                   ReceiverNoise& noise, SimDuration timeout);

  // Takes a query. A repetition of a query that is still waiting changes nothing. `sim` is empty while the
  // simulation time is unknown.
  void submit(const LinkQuery& query, std::optional<SimTime> sim, SimTime steady);
  // Returns the replies that are complete at `steady` or whose deadline has passed.
  std::vector<LinkReply> take_replies(SimTime steady);
  // Returns the earliest deadline; at_once() while a reply is complete.
  SimTime due() const;

 private:
  struct ResolvedEnd {
    LinkAnswer::Status status = LinkAnswer::Status::kAnswered;
    std::string problem;
    VehicleId id = 0;
    Placement placement;
    VehicleModem modem;
    PlacedVehicle placed() const { return {id, placement, &modem}; }  // points into this end
  };
  struct Waiting {
    LinkReply reply;
    SimTime deadline;
    bool wants_paths = false;
    // Links whose terrain is awaited, and the ends of these links, by the index of the answer.
    std::set<std::size_t> bottoms;
    std::map<std::size_t, std::pair<ResolvedEnd, ResolvedEnd>> ends;
    bool is_done() const { return bottoms.empty(); }
  };
  [[nodiscard]] std::string refusal_of(const LinkQuery& query) const;
  ResolvedEnd resolve(const LinkEndRequest& end, std::optional<SimTime> sim) const;
  ResolvedEnd resolve_vehicle(const LinkEndRequest& end, std::optional<SimTime> sim) const;
  void answer(const ResolvedEnd& from, const ResolvedEnd& to, NoiseOfLinks& noise, Waiting& waiting);
  // Returns the link between two ends. It points to their modems, so both ends must outlive it.
  static EndPair link_of(const ResolvedEnd& from, const ResolvedEnd& to);
  // Sets budget, paths and forecast of the answer, or the problem of a position inside the seabed.
  void set_reception(const ResolvedEnd& from, const ResolvedEnd& to, SimTime at, NoiseOfLinks& noise,
                     LinkAnswer& answer);
  [[nodiscard]] std::string problem_with_seabed(const ResolvedEnd& end) const;
  bool is_ready(SimTime at, const EndPair& link, NoiseOfLinks& noise);
  void take_bottoms(Waiting& waiting);
  void add_details(Waiting& waiting);

  const VehicleRegistry& fleet_;
  Propagation& propagation_;
  LinkPredictor& predictor_;
  ReceiverNoise& noise_;
  SimDuration timeout_;
  std::deque<Waiting> waiting_;
};

}  // namespace halocline::channel_server
