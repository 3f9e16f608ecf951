// SPDX-License-Identifier: BSD-3-Clause
// Search for the eigenrays of one link: its inputs and its results.
//
// These are free functions on values: calls may overlap between threads.
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
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/surface_ends.h"
#include "channel_server/propagation/turned_seas.h"
#include "core/units.h"

namespace halocline::channel_server {

inline constexpr double kDeepestEndM = acoustics::kDeepestWater - 1;  // of a link; the bottom lies below it

// Parameters of propagation along rays.
struct RayModel {
  acoustics::FluidBottom bottom;
  acoustics::SurfaceModel surface = acoustics::SurfaceModel::kAplBubbles;
  acoustics::RayOptions options;               // the frequency is ignored: the transmitter's is used
  bool bounces_follow_range = false;           // bounces_for() each link instead of options.max_bounces
  std::optional<acoustics::RaySolver> solver;  // used if it can solve the link; empty: the simplest that can
  std::optional<Decibels>
      shadow_loss;        // transmission loss where no ray arrives, or too little energy; empty: silence
  bool coherent = false;  // received level: sum of phasors at the centre frequency
  acoustics::FadingModel fading;
  acoustics::Reverberation reverberation;
  double speed_tolerance_mps = 0;  // tolerance for thinning the sound-speed profile, 0..1
  double reuse_distance_m = 0;     // d of path_reuse.h, 0..1000; 0: each link of a table is searched itself
  bool reuse_for_packets = false;  // packets share the searches of link tables
  // Over a rough bottom, paths that are weaker by this than the noise over the transmitter's band, less the
  // receiver's directivity, contribute only their energy (RayOptions::diffuse_below_pressure), -100..100.
  // Ignored where options.diffuse_below_db is 0.
  Decibels diffuse_below_noise{5};
  // A link longer than 10 water depths whose paths together are weaker by this than that limit is computed by
  // its incoherent energy flux alone, -100..100 (acoustics/link/energy_flux.h). A value below 0 includes
  // links whose paths together exceed the limit.
  Decibels weak_below_diffuse{6};
  // Range of the depth of the water wherever sound travels, as far as it is known, m; it bounds the reach of
  // sound. 0..kDeepestWater, rising.
  double least_depth_m = 0, greatest_depth_m = acoustics::kDeepestWater;
  int max_searches_per_tick = 0;  // limit for link tables (search_scheduler.h); 0: unlimited
  bool holds_terrain = true;      // beyond the terrain its last depth continues; false: no sound passes there
  // Bubbles and waves near the surface act on paths that fade, and waves on these ends; empty: on none.
  std::optional<SurfaceEnds> near_surface = {};
  // Cache of the sound that boundaries turn, where fading.turns; null: RayPropagation makes one.
  std::shared_ptr<const TurnedSeas> turned = nullptr;
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const RayModel& model);

// Returns the surface for ray tracing.
acoustics::RaySurface surface_of(const RayModel& model, const acoustics::Environment& environment);
// True when scattered sound goes on at new angles.
inline bool turns_sound(const RayModel& model) { return model.fading.enabled && model.fading.turns; }
// Returns the model with a cache of turned sound where it needs one.
RayModel with_turned_seas(RayModel model);

// Horizontal positions of the ends of a bottom profile: north and east of the first end, then of the last, m.
using ProfileEnds = std::array<double, 4>;

// Query of one search. The link runs from the first end of the profile to the last.
struct PathQuery {
  // Key of a query; it begins with a hash of the positions.
  using Key = std::tuple<std::uint64_t, EnvironmentTimeline::WaterId, double, ProfileEnds, std::int64_t,
                         const SeabedProfile*, double, double, double, double>;

  EnvironmentTimeline::WaterId water_id = 0;
  double frequency_hz = 0;
  ProfileEnds places = {};  // ends of the bottom, unless given, and of a field's section
  std::int64_t seabed_version = 0;
  std::shared_ptr<const SeabedProfile> given = {};
  acoustics::RayLink link = {};
  double diffuse_below_pressure = 0;  // see acoustics::RayOptions

  // Returns a value that is equal for queries along one line in one sea, whatever the depths of the ends.
  auto line() const {
    return std::tuple(water_id, frequency_hz, places, seabed_version, given.get(), link.range_m,
                      diffuse_below_pressure);
  }
  // Returns a value that is equal for queries with the same answer.
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

// Eigenrays of a query, and what the search learned of the water and the bottom between the ends.
struct SearchResult {
  std::shared_ptr<const SeabedProfile> given;  // the given bottom, whose address is in the key
  acoustics::Eigenrays eigenrays;
  double mean_depth_m = 0;      // mean depth of the water between the ends
  bool blocked = false;         // the bottom cuts the straight line
  bool beyond_terrain = false;  // see SeabedProfile
};

// Returns the water along the query's link: `water` or, where the environment has a field, the section of the
// field between the query's positions down to `deepest_m` (acoustics/link/field_section.h).
acoustics::LinkWater water_along(const RayModel& model, const acoustics::RayWater& water,
                                 const acoustics::Environment& environment, const PathQuery& query,
                                 double deepest_m);

// Sea that a query is searched in, and the mean depth of the water along its link, m.
struct PathSea {
  acoustics::RaySea sea;
  double mean_depth_m;
};
PathSea path_sea(const RayModel& model, const acoustics::RayWater& water,
                 const acoustics::Environment& environment, const PathQuery& query,
                 const SeabedProfile& seabed);

// Searches for the query's eigenrays over the given bottom, in the query's water.
std::shared_ptr<const SearchResult> search_paths(const RayModel& model, const acoustics::RayWater& water,
                                                 const acoustics::Environment& environment,
                                                 const PathQuery& query, const SeabedProfile& seabed);

// Search for the eigenrays of links that differ only in the depths of their ends: their sea is built once.
// Not to be shared between threads.
class PathLine {
 public:
  // Searches like search_paths(), which is used where an end lies below the bottom. With `shared` rays, links
  // may differ as those rays allow (acoustics::SharedRays); the first call must have the greatest range, and
  // the mean depth is that of its link.
  std::shared_ptr<const SearchResult> search(const RayModel& model, const acoustics::RayWater& water,
                                             const acoustics::Environment& environment,
                                             const PathQuery& query, const SeabedProfile& seabed,
                                             acoustics::SharedRays* shared = nullptr);

 private:
  std::unique_ptr<const PathSea> sea_;  // built by the first call
};
// Links whose searches share rays as well as their sea.
struct SharedLine {
  // For receivers at several depths of one position (acoustics/rays/depth_fan.h).
  static SharedLine of_depths();
  // For receivers along one bearing (acoustics/rays/range_fan.h); the furthest must be searched
  // first.
  static SharedLine of_ranges(std::vector<double> rising_ranges_m);

  PathLine line;
  std::unique_ptr<acoustics::SharedRays> rays;  // refers to the sea of `line`
};

// Returns the eigenrays of a link by its incoherent energy flux alone (acoustics/link/energy_flux.h), when
// the link is weak enough and its bottom uneven enough; null for other links.
std::shared_ptr<const SearchResult> flux_only_paths(const RayModel& model, const acoustics::RayWater& water,
                                                    const acoustics::Environment& environment,
                                                    const PathQuery& query, const SeabedPlaces& seabed);

// False when flux_only_paths() would be null whatever the bottom, so that the bottom need not be looked up.
bool may_be_flux_only(const RayModel& model, const acoustics::RayWater& water, const PathQuery& query);

// Returns the greatest number of bounces of a link's paths: 0.6 of range over mean depth (above 0), from 60
// to 10 000. A path that descends by the depth D between two bounces meets the boundaries
//
//   r tan(angle) / D
//
// times over the range r. So paths of up to 31 degrees are included, the critical angle of medium sand;
// steeper ones lose several dB at each bounce.
int bounces_for(double range_m, double depth_m);

// Returns the mean depth of the bottom between the ends of a link, from 16 points, m.
double mean_depth_m(const acoustics::BottomProfile& bottom, double range_m);

// Returns by how much the level of a link may exceed the sum of its paths' powers in water without focusing
// (acoustics/link/least_loss.h). The values are our choices: 10 dB where phasors are added, 3 dB where only
// paths whose fading is coherent add as phasors; plus 10 dB for the tail of reverberation; plus 6 dB where
// the straight path, which is used without a bottom, spreads by less than 1.5 * 10 log r.
//
// Where scattered sound turns, 2 dB more. Of rays that turn at random between the angles a lossless sea would
// fill evenly, exp(-loss) is on the mean at most that of rays which keep their angles, by Jensen's
// inequality; a receiver's factor 1 / cos(angle), whose mean is pi / 2, may then meet sound that has lost
// less.
Decibels gain_beyond_powers(const RayModel& model, const acoustics::Environment& environment);

// Returns the wanted solver where it can solve the link, else the simplest that can; empty: the simplest.
std::optional<acoustics::RaySolver> usable_solver(std::optional<acoustics::RaySolver> wanted,
                                                  const acoustics::RaySea& sea,
                                                  const acoustics::RayLink& link);

}  // namespace halocline::channel_server
