// SPDX-License-Identifier: BSD-3-Clause
// Reuse of eigenrays: the one rule by which a search serves several links of link tables, and one link for
// several ticks.
//
// When. Links whose ends lie in the same cells have one query and share its search. With d as the distance of
// reuse (RayModel::reuse_distance_m), the cells are
//
//   both ends of the bottom profile, north and east   a lattice of d
//   range                                             d
//   depths                                            d / 10, because the wavefronts of nearly horizontal
//                                                     sound curve most across depth
//
// Cells of range and depth are halved until the link is at least 20 of them long; a link shorter than 20 / 64
// of d is searched itself. The searched link is the middle of the cells, so within 2.5 % of the range in
// range and 0.25 % of it in depth. An end exactly at a knot of the sound-speed profile keeps its depth,
// because the ray tube there differs from those of both layers beside it. So the query is a function of the
// link alone, whatever was searched before. With a limited number of searches a tick a link keeps an older
// query (search_scheduler.h). Phasors are never reused: a phase changes within centimetres.
//
// How. acoustics/rays/extrapolate_eigenrays.h extrapolates the eigenrays of the searched link to the ends of
// the link itself.
//
// Pure functions: calls may overlap between threads.
#pragma once

#include <optional>

#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "channel_server/propagation/path_search.h"

namespace halocline::channel_server {

// Weight of a change in depth over one in the horizontal.
inline constexpr double kDepthsCount = 10;

// True when links of tables share searches.
inline bool reuses_paths(const RayModel& model) { return model.reuse_distance_m > 0 && !model.coherent; }

// Returns the link that is searched in place of `link`; empty when it is too short for cells of `distance_m`,
// which is above 0.
std::optional<acoustics::RayLink> middle_of_cell(const acoustics::RayLink& link, double distance_m);

// Returns the query that is searched in place of `query`, the exact query of a link in `water`.
PathQuery query_of_cell(PathQuery query, const acoustics::RayWater& water, double distance_m);

// Returns the eigenrays of `link` from those `found` for the searched query in its water; empty when `link`
// is the searched link.
std::optional<acoustics::Eigenrays> reused_eigenrays(const acoustics::RayLink& link,
                                                     const PathQuery& searched,
                                                     const acoustics::RayWater& water,
                                                     const acoustics::Environment& environment,
                                                     const acoustics::Eigenrays& found);

}  // namespace halocline::channel_server
