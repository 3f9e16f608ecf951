// SPDX-License-Identifier: BSD-3-Clause
// Finds out by rays which echoes the bottom can send along one link: the geometry between the terrain, which
// the service knows, and acoustics/link/multipath.h.
//
// Two questions, because the second needs the answer to the first:
//   1. how deep is the bottom under `count` points of the line between the ends (the middles of equal parts);
//   2. is the way from each end to each of these points free. Both ways are queried from the end down, and a
//      little short of the point, so that the bottom there does not count as being in its own way.
// A point or way without an answer (outside, no data) leaves the survey incomplete: then
// an echo that is found is likely, and none found means unknown.
//
//   EchoSurvey survey(a, b, 9);
//   survey.take_depths(answers_to(survey.depth_rays()));
//   survey.take_ways(answers_to(survey.way_rays()));
//   const Multipath echoes = multipath_of(survey, /*reversed=*/false, now, propagation, transmitter,
//   receiver);
//
// The same survey serves both directions of the link.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "acoustics/link/multipath.h"
#include "acoustics/modem/modem.h"
#include "channel_server/links/link_table.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/terrain_rays.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class EchoSurvey {
 public:
  // How short of the bottom point a way ends, m: more than the error of a stored seabed, less than any relief
  // that matters to sound.
  static constexpr double kShortOfBottomM = 0.01;

  EchoSurvey() = default;
  // `point_count` >= 1.
  EchoSurvey(const Vec3& from_ned_m, const Vec3& to_ned_m, int point_count);

  // The kind of its next query; empty after the last. Rays and answers of that query.
  std::optional<RayKind> next_query() const;
  std::vector<TerrainRay> rays() const { return stage_ == Stage::kDepths ? depth_rays() : way_rays(); }
  void take(std::span<const RayAnswer> answers);

  // One a point, straight down.
  std::vector<TerrainRay> depth_rays() const;
  // As many answers as depth_rays().
  void take_depths(std::span<const RayAnswer> answers);
  // From `from`, then from `to`, for each point whose depth is known; empty when none is.
  std::vector<TerrainRay> way_rays() const;
  // As many answers as way_rays().
  void take_ways(std::span<const RayAnswer> answers);

  const Vec3& from_ned_m() const { return from_; }
  const Vec3& to_ned_m() const { return to_; }
  std::size_t points_asked() const { return asked_.size(); }
  // The points that are known, "transmitter" being `from`.
  const std::vector<acoustics::BottomPoint>& bottom() const { return bottom_; }
  // Everything has an answer.
  bool complete() const { return complete_; }

 private:
  enum class Stage { kDepths, kWays, kDone };
  Stage stage_ = Stage::kDepths;
  Vec3 from_ = Vec3::Zero(), to_ = Vec3::Zero();
  std::vector<Vec3> asked_;
  std::vector<acoustics::BottomPoint> bottom_;
  bool complete_ = false;
};

// The answer for one direction, in the water of `at`: `reversed` when the transmitter is the survey's `to`.
Multipath multipath_of(const EchoSurvey& survey, bool reversed, SimTime at, Propagation& propagation,
                       const acoustics::Modem& transmitter, const acoustics::Modem& receiver);

}  // namespace halocline::channel_server
