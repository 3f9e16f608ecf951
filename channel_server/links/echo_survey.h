// SPDX-License-Identifier: BSD-3-Clause
// A survey by rays of the bottom echoes that are possible along one link. It connects the terrain, which the
// terrain service knows, with acoustics/link/multipath.h.
//
// The survey has two queries, because the second needs the answer to the first:
//   1. depths: how deep is the bottom under `count` points of the line between the ends, the middles of equal
//      parts of it;
//   2. ways: is the straight line from each end to each of these bottom points free? Rays start at the ends
//      and stop a little short of the point, so that the bottom there does not block its own ray.
// A point or way without an answer (outside the terrain, no data) leaves the survey incomplete: then an echo
// that is found is likely, but none found means unknown.
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
  // The distance from the bottom point at which a ray ends, m: more than the error of a stored seabed, less
  // than any relief that matters to sound.
  static constexpr double kShortOfBottomM = 0.01;

  EchoSurvey() = default;
  // `point_count` must be at least 1.
  EchoSurvey(const Vec3& from_ned_m, const Vec3& to_ned_m, int point_count);

  // Returns the kind of the next query; empty after the last. rays() returns the rays of that query, take()
  // takes its answers.
  std::optional<RayKind> next_query() const;
  std::vector<TerrainRay> rays() const { return stage_ == Stage::kDepths ? depth_rays() : way_rays(); }
  void take(std::span<const RayAnswer> answers);

  // Returns one ray for each point, straight down.
  std::vector<TerrainRay> depth_rays() const;
  // Takes one answer for each of depth_rays(); throws if the count differs.
  void take_depths(std::span<const RayAnswer> answers);
  // Returns the rays from `from` and from `to` to each point whose depth is known; empty when no depth is
  // known.
  std::vector<TerrainRay> way_rays() const;
  // Takes one answer for each of way_rays(); throws if the count differs.
  void take_ways(std::span<const RayAnswer> answers);

  const Vec3& from_ned_m() const { return from_; }
  const Vec3& to_ned_m() const { return to_; }
  std::size_t points_asked() const { return asked_.size(); }
  // Returns the bottom points whose depth is known; `from` counts as the transmitter.
  const std::vector<acoustics::BottomPoint>& bottom() const { return bottom_; }
  // True when every depth and way has an answer.
  bool complete() const { return complete_; }

 private:
  enum class Stage { kDepths, kWays, kDone };
  Stage stage_ = Stage::kDepths;
  Vec3 from_ = Vec3::Zero(), to_ = Vec3::Zero();
  std::vector<Vec3> asked_;
  std::vector<acoustics::BottomPoint> bottom_;
  bool complete_ = false;
};

// Returns the verdict for one direction, in the water at `at`. `reversed` means that the transmitter is at
// the survey's `to`.
Multipath multipath_of(const EchoSurvey& survey, bool reversed, SimTime at, Propagation& propagation,
                       const acoustics::Modem& transmitter, const acoustics::Modem& receiver);

}  // namespace halocline::channel_server
