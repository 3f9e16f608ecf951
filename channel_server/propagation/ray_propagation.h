// SPDX-License-Identifier: BSD-3-Clause
// Propagation along rays over the known bottom between the ends of a link.
//
// Model. acoustics/rays/search/eigenray_search.h finds the paths. The level of each path is, in dB,
//
//   source level - spreading - losses at bounces - absorption - loss of both beams
//
// with the transmitter's beam at the launch angle and the receiver's looking back along the arriving ray, so
// at minus the arrival angle. The level of the link is the sum of the paths' powers or, on request, the sum
// of their phasors at the exact ends.
//
// In the budget, the delay is that of the strongest path in the receiver's guard window; mean sound speed
// (range over delay) and absorption are those of the first significant path. Transmission loss = source level
// - received level; noise, signal-to-noise ratio and whether the link is receivable follow. Capacity takes
// that loss at the centre of the band. Elsewhere in the band the loss differs by as much as absorption does,
// in water between the two depths, over the length of the first significant path
// (LinkKernel::budget_of_path). Doppler of each path: acoustics/link/ray_doppler.h.
//
// Without a path the state is
//
//   too weak, too steep  rays arrive beyond the limits of the search
//   blocked              no ray arrives, and the bottom cuts the straight line between the ends
//   shadow               no ray arrives otherwise
//
// Then the level is kSilence or, in a shadow and where rays are too weak, the configured floor; the delay is
// that of the straight line, and nothing is receivable. Where the bottom is unknown (no terrain there, or no
// answer from the bathymetry service), the straight path is used.
//
// Paths are searched from the lower id to the higher. The reverse direction has the same paths backwards, so
// the two are reciprocal to the last bit, except for what the receiver's noise makes diffuse
// (RayModel::diffuse_below_noise).
//
// reception() searches every link by itself. receptions(), for tables, may let links share searches
// (path_reuse.h); so may packets. With a limited number of searches a tick, a link may keep the paths of an
// earlier tick: Reception::paths_age.
//
// Ends above the surface are placed on it. Left out: the slope of the bottom across the link
// (acoustics/rays/search/eigenray_search.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/reverberation.h"
#include "acoustics/link/least_loss.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/modem/modem.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/link_chart.h"
#include "channel_server/propagation/link_searches.h"
#include "channel_server/propagation/path_exchange.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_arrival.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/straight_propagation.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

class RayPropagation : public Propagation {
 public:
  // Throws InvalidArgument when the model is out of range.
  RayPropagation(std::shared_ptr<const EnvironmentTimeline> waters, std::shared_ptr<SeabedMap> seabed,
                 const RayModel& model);
  RayPropagation(const RayPropagation&) = delete;
  RayPropagation& operator=(const RayPropagation&) = delete;

  Reception reception(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return along_rays(at, searches_.for_itself(at, from, to), acoustics::Capacity::kComputed);
  }
  Reception reception_without_capacity(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return along_rays(at, searches_.for_packet(at, from, to), acoustics::Capacity::kLeftOut);
  }
  std::vector<std::optional<Reception>> packet_receptions(SimTime at, const std::vector<EndPair>& links,
                                                          const ForEach& for_each) override;
  bool plans_ticks() const override { return searches_.has_scheduler(); }
  void begin_tick(SimTime at, const std::vector<EndPair>& all) override { searches_.begin_tick(at, all); }
  bool share_searches(PathExchange& exchange) override {
    searches_.share_through(exchange);
    return true;
  }
  void prepare_tables(SimTime at, const std::vector<EndPair>& links, const ForEach& for_each) override {
    searches_.find_shared(at, links, for_each);
  }
  std::vector<Reception> receptions(SimTime at, const std::vector<EndPair>& links,
                                    const ForEach& for_each) override;
  bool is_ready(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return searches_.is_ready(searches_.for_itself(at, from, to));
  }
  bool is_ready_for_packet(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return searches_.is_ready(searches_.for_packet(at, from, to));
  }
  bool are_ready(SimTime at, const std::vector<EndPair>& links) override;
  bool uses_bottom() const override { return true; }
  double depth_inside_seabed_m(const Vec3& place_ned_m) const override {
    return place_ned_m.z() - seabed_->seabed_z_m(place_ned_m).value_or(place_ned_m.z());
  }
  Reception reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                           const std::shared_ptr<const SeabedProfile>& seabed) override;
  // Returns reception_over() without a capacity, for links from one end that share rays through `line`; null:
  // the link by itself.
  Reception reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                           const std::shared_ptr<const SeabedProfile>& seabed, SharedLine* line);
  LinkChart chart(SimTime at, const LinkEnd& from, const LinkEnd& to) override;
  std::optional<acoustics::LeastLoss> least_loss(SimTime at, double frequency_hz,
                                                 double deepest_end_m) const override;
  std::optional<FluxOnlyLinks> flux_only_links(SimTime at, double frequency_hz,
                                               double deepest_end_m) const override;
  const acoustics::Environment& environment(SimTime at) const override { return waters_->at(at); }

  std::int64_t searches() const { return searches_.searches(); }  // for eigenrays, since the start

 private:
  using Task = LinkSearches::Task;

  std::vector<Task> table_tasks(SimTime at, const std::vector<EndPair>& links);
  // Returns the reception along rays, or along the straight path where the bottom is unknown.
  Reception along_rays(SimTime at, const Task& task, acoustics::Capacity capacity);
  Reception straight_instead(SimTime at, const EndPair& ends, PropagationUsed used,
                             acoustics::Capacity capacity = acoustics::Capacity::kComputed);
  Reception answer(const Task& task, const SearchResult& found, acoustics::Capacity capacity) const;
  // True when the seabed of the search rests on depths beyond the terrain, which the model does not hold.
  bool lacks_terrain(const SearchResult& found) const {
    return found.beyond_terrain && !model_.holds_terrain;
  }
  static PathState state_without_path(const SearchResult& found);
  std::vector<Arrival> arrivals(const Task& task, const acoustics::Eigenrays& eigenrays,
                                double depth_m) const;
  Decibels received_level(const Task& task, const acoustics::Eigenrays& eigenrays,
                          const std::vector<Arrival>& paths) const;
  void set_open(const Task& task, const acoustics::Eigenrays& eigenrays, acoustics::Capacity capacity,
                Reception& reception) const;
  void set_silent(const Task& task, acoustics::Capacity capacity, Reception& reception) const;

  std::shared_ptr<const EnvironmentTimeline> waters_;
  std::shared_ptr<SeabedMap> seabed_;
  RayModel model_;
  RoughBoundaries boundaries_;
  StraightPropagation straight_;
  LinkSearches searches_;
};

}  // namespace halocline::channel_server
