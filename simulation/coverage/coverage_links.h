// SPDX-License-Identifier: BSD-3-Clause
// Links from one end to receivers with the scenario's modem at any position: the computation behind coverage
// maps and tracks.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/environment.h"
#include "bathymetry/terrain/terrain.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/water_model.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "simulation/coverage/sampling.h"
#include "simulation/link_survey.h"
#include "simulation/link_surveyor.h"

namespace halocline::clients {

// Selects which links over terrain share a ray search.
enum class RaySharing {
  kNone,  // a search for each link, as in `halocline link`
  // One search for the depths of a place; paths between depths are interpolated where that is verified
  // (acoustics/rays/depth_fan.h).
  kDepths,
  // One fan of rays for all ranges on a bearing, over the bottom along that bearing
  // (acoustics/rays/range_fan.h).
  kRanges
};

// Links from one end, with the water and terrain of a scenario.
class CoverageLinks {
 public:
  struct Scene {
    const ScenarioConfig& config;  // must outlive this
    std::shared_ptr<const bathymetry::Terrain> terrain;
    LinkSurveyEnd from;
  };
  explicit CoverageLinks(const Scene& scene);

  // Calls item(surveyor, i) for each i below `count`. Each of `threads` threads has its own surveyor and
  // takes every `threads`-th item.
  void share(int threads, std::size_t count,
             const std::function<void(LinkSurveyor&, std::size_t)>& item) const;
  // True when the water varies horizontally (an ocean field).
  bool is_in_a_field() const { return static_cast<bool>(environment().field); }
  // True when a vehicle makes noise, so that links of equal range differ.
  bool is_among_noise() const;
  double noise_level_db() const;  // of the ambient noise
  // True when sound meets the last depth beyond the terrain; false: no sound passes there.
  bool holds_terrain() const { return config_.channel_server.propagation.rays.holds_terrain; }
  // Returns an empty seabed map with the settings that the scenario's links use.
  channel_server::SeabedMap seabed_map() const;
  // Surveys the seabed that rays to a position need; does nothing for straight paths.
  void survey(const Vec3& to_ned_m, channel_server::SeabedMap& seabed) const;
  // Returns the bottom profile to a position that was surveyed; null for straight paths.
  LinkSurveyor::Seabed bottom(const Vec3& to_ned_m, const channel_server::SeabedMap& seabed) const;
  // Computes links to receivers at one horizontal position and at each z of `z_m`, ascending. Threads may
  // call it at the same time, each with its own surveyor and line; a null line shares no rays.
  std::vector<Sample> links(LinkSurveyor& surveyor, const Vec3& place_ned_m, const std::vector<double>& z_m,
                            const LinkSurveyor::Seabed& seabed, channel_server::SharedLine* line) const;
  // Computes the same for a position that shares no rays with others: its depths share a fan unless `sharing`
  // is kNone.
  std::vector<Sample> links_to_one_place(LinkSurveyor& surveyor, const Vec3& place_ned_m,
                                         const std::vector<double>& z_m, const LinkSurveyor::Seabed& seabed,
                                         RaySharing sharing) const;
  // Returns the bottom profile to a position as rays use it.
  acoustics::BottomProfile bottom_profile(const Vec3& to_ned_m,
                                          const channel_server::SeabedProfile& seabed) const;
  Sample link(LinkSurveyor& surveyor, const Vec3& to_ned_m, const LinkSurveyor::Seabed& seabed) const {
    return sample(surveyor, to_ned_m, seabed, nullptr);
  }

 private:
  LinkSurveyor surveyor() const { return {config_, terrain_, sources_}; }
  const acoustics::Environment& environment() const { return sources_.timeline.at(SimTime()); }
  bool along_rays() const;
  Sample sample(LinkSurveyor& surveyor, const Vec3& to_ned_m, const LinkSurveyor::Seabed& seabed,
                channel_server::SharedLine* line) const;

  const ScenarioConfig& config_;
  std::shared_ptr<const bathymetry::Terrain> terrain_;
  LinkSurveyEnd from_;
  channel_server::VehicleModem to_;
  channel_server::WaterSources sources_;
};

}  // namespace halocline::clients
