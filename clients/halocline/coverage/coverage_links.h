// SPDX-License-Identifier: BSD-3-Clause
// Links from one end to receivers with the scenario's modem, wherever they are: what maps and tracks of
// coverage are made of.
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
#include "clients/halocline/coverage/sampling.h"
#include "clients/halocline/scenario/composition.h"
#include "clients/halocline/scenario/link_survey.h"
#include "clients/halocline/scenario/link_surveyor.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

// What links share of their rays over terrain.
enum class RaySharing {
  kNone,     // each has a search of its own, as `halocline link`
  kDepths,   // depths of a place have one, and paths between depths are interpolated where that is verified
             // (acoustics/rays/column_rays.h)
  kBearings  // places of a bearing have one fan, along whose bearing the bottom is taken
             // (acoustics/rays/bearings/bearing_rays.h)
};

class CoverageLinks {
 public:
  struct Scene {
    const ScenarioConfig& config;  // outlives this
    std::shared_ptr<const bathymetry::Terrain> terrain;
    LinkSurveyEnd from;
  };
  explicit CoverageLinks(const Scene& scene);

  // Calls item(surveyor, i) for each i below `count`; `threads`, of which each has a surveyor, take every so
  // many of them.
  void share(int threads, std::size_t count,
             const std::function<void(LinkSurveyor&, std::size_t)>& item) const;
  // Whether the water changes from place to place.
  bool is_in_a_field() const { return static_cast<bool>(environment().field); }
  double noise_level_db() const;
  // Empty, of the kind that links of the scenario take their profiles from.
  channel_server::SeabedMap seabed_map() const;
  // Surveys what rays to a place need of the seabed, and nothing where links are straight.
  void survey(const Vec3& to_ned_m, channel_server::SeabedMap& seabed) const;
  // The bottom to a place that was surveyed; null where links are straight.
  LinkSurveyor::Seabed bottom(const Vec3& to_ned_m, const channel_server::SeabedMap& seabed) const;
  // Links to receivers above and below one place at each z of `z_m`, rising. Calls may overlap between
  // threads, each with a surveyor and a line of its own; null: none are shared.
  std::vector<Sample> links(LinkSurveyor& surveyor, const Vec3& place_ned_m, const std::vector<double>& z_m,
                            const LinkSurveyor::Seabed& seabed, channel_server::SharedLine* line) const;
  // The same where no other place shares rays: its depths do, unless nothing is to be shared.
  std::vector<Sample> links_to_one_place(LinkSurveyor& surveyor, const Vec3& place_ned_m,
                                         const std::vector<double>& z_m, const LinkSurveyor::Seabed& seabed,
                                         RaySharing sharing) const;
  // The bottom to a place, as rays meet it.
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
