// Sound along rays, over the bottom that is known between the ends of a link.
//
// Model: acoustics/rays/eigenray.h gives the paths; each has the level
//   source level - spreading - bounces - absorption - beams (the sender's at the launch angle; the receiver's looking
//   back along the arriving ray, so at minus the arrival angle),
// and the link the sum of their powers (or, if wished, of their phasors for the ends exactly where they are). In
// the budget: delay, mean sound speed (range over delay) and absorption are those of the first significant path;
// transmission loss = source level - received level; noise, signal-to-noise ratio and what is receivable follow;
// capacity takes that loss at the centre of the band, and elsewhere in the band as much more or less as water
// between the two depths absorbs more or less over the length of the first significant path
// (LinkKernel::budget_of_path). Doppler of each path is that of acoustics/link/ray_doppler.h.
// Where there is no path: too weak or too steep when rays arrive beyond the limits of the search, blocked when none does
// and the bottom cuts the straight line between the ends, in a shadow otherwise; the level is kSilence or, in a shadow
// and where rays are too weak, that of the stated floor, the delay that of the straight line, and nothing is receivable.
// Where the bottom is not known (no terrain there, or no answer of who knows it): the straight path.
//
// Paths are searched from the end where the bottom profile starts (the lower id) to the other; the other direction is
// the same paths backwards, so the two are reciprocal to the last bit (but for what the receiver's noise makes diffuse:
// RayModel::diffuse_below_noise). reception() searches every link for itself, over the bottom between its very ends.
// receptions(), for tables, may let links share, and packets too with RayModel::reuse_for_packets: with a distance of reuse, both
// ends go to the nearest points of a horizontal lattice for the bottom, the search is for the middle of the cell that the
// link lies in (path_search.h), and its paths are extrapolated from there to the link
// (acoustics/link/extrapolate_arrivals.h); not for coherent levels. With a budget of searches a tick (search_budget.h) a link
// may keep the paths of an earlier tick, extrapolated likewise: Reception::paths_age. Otherwise results are functions of
// environment, terrain and ends alone: a search is kept for the very same query, and done again when it was forgotten. Ends
// above the surface are taken at it. Left out: motion of the bottom's slope across the link (acoustics/rays/eigenray.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/reverberation.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/link/least_loss.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/link/multipath.h"
#include "acoustics/modem/modem.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/link_tracks.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/received_path.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/search_budget.h"
#include "channel_server/propagation/straight_propagation.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "core/lru_cache.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

class RayPropagation : public Propagation {
 public:
  // Throws InvalidArgument when the model is out of range.
  RayPropagation(std::shared_ptr<const EnvironmentTimeline> waters, std::shared_ptr<SeabedMap> seabed,
                 const RayModel& model);

  Reception reception(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return along_rays(at, task_of(at, from, to, from.id > to.id), found_);
  }
  Reception reception_without_capacity(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    Task task = packet_task_of(at, from, to);
    task.capacity = acoustics::Capacity::kLeftOut;
    return along_rays(at, task, model_.reuse_for_packets ? shared_found_ : found_);
  }
  bool plans_ticks() const override { return budget_.has_value(); }
  void begin_tick(SimTime at, const std::vector<EndPair>& all) override;
  std::vector<Reception> receptions(SimTime at, const std::vector<EndPair>& links,
                                    const ForEach& for_each) override;
  bool is_ready(SimTime at, const LinkEnd& from, const LinkEnd& to) override;
  bool are_ready(SimTime at, const std::vector<EndPair>& links) override;
  bool uses_bottom() const override { return true; }
  double depth_inside_seabed_m(const Vec3& place_ned_m) const override {
    return place_ned_m.z() - seabed_->seabed_z_m(place_ned_m).value_or(place_ned_m.z());
  }
  Reception reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                           const std::shared_ptr<const SeabedProfile>& seabed) override;
  // The paths behind reception_over(), one for each of its own but those of reverberation, in their order. Amplitudes
  // are without the beams of the modems.
  acoustics::Arrivals arrivals_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                    const std::shared_ptr<const SeabedProfile>& seabed);
  LinkTracks tracks(SimTime at, const LinkEnd& from, const LinkEnd& to) override;
  bool echo_is_receivable(SimTime at, const acoustics::Modem& transmitter, const acoustics::Modem& receiver,
                          const Vec3& from_ned_m, const Vec3& to_ned_m,
                          const std::vector<acoustics::BottomPoint>& points) override {
    return straight_.echo_is_receivable(at, transmitter, receiver, from_ned_m, to_ned_m, points);
  }
  std::optional<acoustics::LeastLoss> least_loss(SimTime at, double frequency_hz,
                                                 double deepest_end_m) const override;
  const acoustics::Environment& environment(SimTime at) const override { return waters_->at(at); }

  std::int64_t searches() const { return searches_; }  // of paths, since the start

 private:
  using PathsPointer = std::shared_ptr<const FoundPaths>;
  // A link, ready to be computed without touching the caches once its bottom is there.
  struct Task {
    EndPair ends;
    const acoustics::Environment* environment;
    std::shared_ptr<const acoustics::RayWater> water;
    std::shared_ptr<const acoustics::LinkKernel> kernel;
    PathQuery query;
    acoustics::RayLink link;  // where the ends are; the query's own unless its paths are extrapolated
    bool reversed = false;    // the transmitter is the profile's last end
    acoustics::Capacity capacity = acoustics::Capacity::kComputed;
    SearchBudget::Granted* granted =
        nullptr;           // the query's; null without a budget, and before the link's first turn
    bool waits = false;    // for that turn
    SimDuration age = {};  // since the query was the link's own
  };

  std::shared_ptr<const SeabedProfile> seabed_of(const PathQuery& query) const;
  std::shared_ptr<const acoustics::RayWater> water_of(SimTime at, double frequency_hz);
  Task task_of(SimTime at, const LinkEnd& from, const LinkEnd& to, bool reversed);
  Task task_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                 const std::shared_ptr<const SeabedProfile>& seabed);
  bool is_surveyed(const ProfileEnds& places) {
    return seabed_->is_surveyed({places[0], places[1], 0}, {places[2], places[3], 0});
  }
  // For a table: the query may be that of a cell, shared by links near it.
  Task shared_task_of(SimTime at, const LinkEnd& from, const LinkEnd& to);
  // The same; where the budget does not allow for that, the query that the link was last granted.
  Task table_task_of(SimTime at, const LinkEnd& from, const LinkEnd& to);
  PathsPointer search(const Task& task, const SeabedProfile& seabed) const {
    return search_paths(model_, *task.water, *task.environment, task.query, seabed);
  }
  // For a packet: as for a table where packets share searches; a link without a turn yet searches for itself.
  Task packet_task_of(SimTime at, const LinkEnd& from, const LinkEnd& to);
  using FoundCache = LruCache<PathQuery::Key, PathsPointer>;
  // Null where the bottom is not known.
  PathsPointer found(const Task& task, FoundCache& cache);
  // What is known already; null otherwise.
  PathsPointer known(const Task& task);
  // Straight where the bottom is not known.
  Reception along_rays(SimTime at, const Task& task, FoundCache& cache);
  Reception straight_instead(SimTime at, const EndPair& ends, PropagationUsed used,
                             acoustics::Capacity capacity = acoustics::Capacity::kComputed);
  Reception answer(const Task& task, const FoundPaths& found) const;
  static PathState state_without_path(const FoundPaths& found);
  // What was found, at the ends of the task.
  acoustics::Arrivals arrivals_at(const Task& task, const FoundPaths& found) const;
  std::vector<SoundPath> sound_paths(const Task& task, const acoustics::Arrivals& arrivals) const;
  Decibels received_level(const Task& task, const acoustics::Arrivals& arrivals,
                          const std::vector<SoundPath>& paths) const;
  void set_open(const Task& task, const acoustics::Arrivals& arrivals, Reception& reception) const;
  void set_silent(const Task& task, Reception& reception) const;

  std::shared_ptr<const EnvironmentTimeline> waters_;
  std::shared_ptr<SeabedMap> seabed_;
  RayModel model_;
  RoughBoundaries boundaries_;
  StraightPropagation straight_;
  LruCache<std::pair<EnvironmentTimeline::WaterId, double>, std::shared_ptr<const acoustics::RayWater>>
      ray_waters_;
  FoundCache found_, shared_found_;  // of links for themselves; of tables, and packets that share them
  std::optional<SearchBudget> budget_;
  std::int64_t searches_ = 0;
};

}  // namespace halocline::channel_server
