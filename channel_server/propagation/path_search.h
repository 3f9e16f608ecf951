// SPDX-License-Identifier: BSD-3-Clause
// The search of one link's paths: what it depends on, and what it finds.
//
// Free function on values: calls may overlap between threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/reverberation.h"
#include "acoustics/link/field_section.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/extrapolate_arrivals.h"
#include "acoustics/rays/traced_ray.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/seabed_profile.h"
#include "core/units.h"

namespace halocline::channel_server {

// How sound goes along rays.
struct RayModel {
  acoustics::FluidBottom bottom;
  acoustics::SurfaceModel surface = acoustics::SurfaceModel::kAplBubbles;
  acoustics::RayOptions options;               // its frequency is not used: the transmitter's is
  bool bounces_follow_range = false;           // bounces_for() a link instead of options.max_bounces
  std::optional<acoustics::RaySolver> solver;  // used where it can do the link; empty: the simplest that can
  std::optional<Decibels>
      shadow_loss;        // transmission loss where no ray gets, or too little of it; empty: silence
  bool coherent = false;  // received level: sum of phasors at the centre frequency
  acoustics::FadingModel fading;
  acoustics::Reverberation reverberation;
  double speed_tolerance_mps = 0;  // knots of the water are thinned to that, 0..1
  double reuse_distance_m =
      0;  // of middle_of_cell(), 0..1000; 0: every link of a table is searched for itself
  bool reuse_for_packets = false;  // packets share the searches of tables
  // Over a rough bottom paths this much weaker than the noise over the transmitter's band, less the
  // receiver's directivity, come as energy alone (RayOptions::diffuse_below_pressure), -100..100. Not where
  // options.diffuse_below_db is 0.
  Decibels diffuse_below_noise{5};
  // The whole of a link of more than 10 depths that is this much weaker still comes as energy, -100..100:
  // below 0, one whose paths together are stronger (acoustics/link/mixed_link.h).
  Decibels weak_below_diffuse{6};
  // Of the water wherever sound goes, as far as it is known, m: for the range that sound reaches.
  // 0..kDeepestWater, rising.
  double least_depth_m = 0, greatest_depth_m = acoustics::kDeepestWater;
  int max_searches_per_tick = 0;         // of link tables, by search_budget.h; 0: as many as they need
  double profile_reuse_distance_m = 25;  // with it: between points of the lattice of ends, 0.1..1000
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const RayModel& model);

// Horizontal places of the ends of a bottom profile: north and east of the first, of the last, m.
using ProfileEnds = std::array<double, 4>;

// The link runs from the profile's first end.
struct PathQuery {
  // Begins with a hash of the places.
  using Key = std::tuple<std::uint64_t, EnvironmentTimeline::WaterId, double, ProfileEnds, std::int64_t,
                         const SeabedProfile*, double, double, double, double>;

  EnvironmentTimeline::WaterId water_id = 0;
  double frequency_hz = 0;
  ProfileEnds places = {};  // of the bottom, unless it is given, and of the water, where it has a field
  std::int64_t seabed_version = 0;
  std::shared_ptr<const SeabedProfile> given = {};
  acoustics::RayLink link = {};
  double diffuse_below_pressure = 0;  // of acoustics::RayOptions

  // Equal for queries of one line and one sea, whatever the depths of the ends.
  auto line() const {
    return std::tuple(water_id, frequency_hz, places, seabed_version, given.get(), link.range_m,
                      diffuse_below_pressure);
  }
  // Equal for queries of the same answer.
  Key key() const {
    return {hash_of_places(),    water_id,
            frequency_hz,        places,
            seabed_version,      given.get(),
            link.source_depth_m, link.receiver_depth_m,
            link.range_m,        diffuse_below_pressure};
  }

  struct KeyHash {
    std::size_t operator()(const Key& key) const { return static_cast<std::size_t>(std::get<0>(key)); }
  };

 private:
  std::uint64_t hash_of_places() const;
};

inline bool is_of_one_sea(const PathQuery& a, const PathQuery& b) {
  return a.water_id == b.water_id && a.seabed_version == b.seabed_version;
}

struct FoundPaths {
  std::shared_ptr<const SeabedProfile> given;  // whose address is in the key
  acoustics::Arrivals arrivals;
  double mean_depth_m = 0;      // between the ends
  bool blocked = false;         // the bottom cuts the straight line
  bool beyond_terrain = false;  // as SeabedProfile's
};

// The water along the query's link: `water`, or where the environment has a field, that between the query's
// places down to the depth (acoustics/link/field_section.h).
acoustics::LinkWater water_along(const RayModel& model, const acoustics::RayWater& water,
                                 const acoustics::Environment& environment, const PathQuery& query,
                                 double deepest_m);
// Sound speeds at the ends of the query's link, likewise.
acoustics::EndSpeeds end_speeds(const acoustics::RayWater& water, const acoustics::Environment& environment,
                                const PathQuery& query);

// The sea of a query, and the mean depth of the water along its link.
struct PathSea {
  acoustics::RaySea sea;
  double mean_depth_m;
};
PathSea path_sea(const RayModel& model, const acoustics::RayWater& water,
                 const acoustics::Environment& environment, const PathQuery& query,
                 const SeabedProfile& seabed);

// Over the bottom that is given, in the water of the query at its instant.
std::shared_ptr<const FoundPaths> search_paths(const RayModel& model, const acoustics::RayWater& water,
                                               const acoustics::Environment& environment,
                                               const PathQuery& query, const SeabedProfile& seabed);

// The searches of links that differ in the depths of their ends alone, whose sea is made once. Not shared
// between threads.
class PathLine {
 public:
  // As search_paths(), which answers itself where an end lies below the bottom. With shared rays links differ
  // in what those say (acoustics::SharedRays), the first call has the greatest range, and the mean depth is
  // that of its link.
  std::shared_ptr<const FoundPaths> search(const RayModel& model, const acoustics::RayWater& water,
                                           const acoustics::Environment& environment, const PathQuery& query,
                                           const SeabedProfile& seabed,
                                           acoustics::SharedRays* shared = nullptr);

 private:
  std::unique_ptr<const PathSea> sea_;  // of the first call
};
struct SharedLine {
  // Of receivers at several depths of one place (acoustics/rays/column_rays.h).
  static SharedLine of_depths();
  // Of receivers along one bearing (acoustics/rays/bearings/bearing_rays.h), of which the furthest is asked
  // for first.
  static SharedLine of_bearing(std::vector<double> rising_ranges_m);

  PathLine line;
  std::unique_ptr<acoustics::SharedRays> rays;  // refers to the sea of the line
};

// The same of a link so weak and over so uneven a bottom that its energy is enough
// (acoustics/link/mixed_link.h); null for others.
std::shared_ptr<const FoundPaths> weak_paths(const RayModel& model, const acoustics::RayWater& water,
                                             const acoustics::Environment& environment,
                                             const PathQuery& query, const SeabedPlaces& seabed);

// Whether that may be found, before its bottom is looked at.
bool may_be_weak(const RayModel& model, const acoustics::RayWater& water, const PathQuery& query);

// Bounces that a link's paths may have: 0.6 of range over mean depth (above 0), 60 at least and 10 000 at
// most. A path that drops by the depth D from one bounce to the next meets the boundaries r tan(angle) / D
// times over the range r, so these are all up to 31 degrees, the critical angle of medium sand; steeper ones
// lose several dB at each bounce.
int bounces_for(double range_m, double depth_m);

// Of the bottom between the ends of a link, m.
double mean_depth_m(const acoustics::BottomProfile& bottom, double range_m);

// What the level of a link may have beside the sum of its paths' powers in even water
// (acoustics/link/least_loss.h), our choices: 10 dB where phasors are added, 3 dB where only those whose
// fading keeps together are; 10 dB for the tail of reverberation; 6 dB where the straight path, which serves
// without a bottom, spreads less than by 1.5 * 10 log r.
Decibels gain_beyond_powers(const RayModel& model, const acoustics::Environment& environment);

// The solver that is wanted where it can do the link, else the simplest that can; empty: the simplest.
std::optional<acoustics::RaySolver> usable_solver(std::optional<acoustics::RaySolver> wanted,
                                                  const acoustics::RaySea& sea,
                                                  const acoustics::RayLink& link);

// Of a path as it was found, from the link's lower end: the same for both directions.
std::uint64_t number_of(const acoustics::PathIdentity& identity);

// Between which points the paths of a link of a table are searched, so that one search serves links that
// differ little; empty: this very one, as it is too short for cells of `distance_m` (above 0).
//
// Range and both depths are each replaced by the middle of their cell: cells are `distance_m` long in
// range and a tenth of that in depth (fronts of sound that travels nearly level bend most across depth), and
// half as large as often as it takes for a link to be at least 20 cells long. Below 20 / 64 of `distance_m`
// nothing is replaced. So the searched link is a function of the link alone, whatever was searched before,
// and lies within 2.5 % of the range in range and 0.25 % of it in depth.
// acoustics/rays/extrapolate_arrivals.h takes the paths from there to the link.
std::optional<acoustics::RayLink> middle_of_cell(const acoustics::RayLink& link, double distance_m);

}  // namespace halocline::channel_server
