// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/ray_service.h"

#include <cmath>
#include <utility>

#include "core/frames.h"

namespace halocline::bathymetry {
namespace {

RayAnswers refused(Refusal refusal, std::string reason) { return {refusal, std::move(reason), {}, {}}; }

std::size_t results_a_ray(QueryMode mode) {
  return mode == QueryMode::kDepthTiles ? kTileSide * kTileSide : 1;
}

RayStatus as_ray_status(DepthStatus status) {
  switch (status) {
    case DepthStatus::kOk:
      return RayStatus::kHit;
    case DepthStatus::kOutside:
      return RayStatus::kOutside;
    case DepthStatus::kNoData:
      return RayStatus::kNoData;
    case DepthStatus::kBadInput:
      break;
  }
  return RayStatus::kBadInput;
}

void append(RayAnswers& answers, RayStatus status, double result_m) {
  answers.statuses.push_back(status);
  answers.results_m.push_back(status == RayStatus::kHit ? result_m : 0);
}

// Appends a point of a tile, whose depth continues beyond the terrain for acoustics.
void append_held(const Terrain& terrain, double x_m, double y_m, RayAnswers& answers) {
  const DepthStatus known = terrain.depth_at(x_m, y_m).status;
  const auto held = terrain.held_depth_at(x_m, y_m);
  answers.statuses.push_back(as_ray_status(known));
  answers.results_m.push_back(held ? held->z_m : 0);
}

void append_depth(const Terrain& terrain, double x_m, double y_m, RayAnswers& answers) {
  const DepthSample sample = terrain.depth_at(x_m, y_m);
  append(answers, as_ray_status(sample.status), sample.z_m);
}

// Points are products of integers and the spacing, so everybody computes the same bits.
void append_tile(const Terrain& terrain, const Vec3& origin, double spacing_m, RayAnswers& answers) {
  const double north = std::round(origin.x() / spacing_m), east = std::round(origin.y() / spacing_m);
  for (std::size_t i = 0; i < kTileSide; ++i) {
    for (std::size_t j = 0; j < kTileSide; ++j)
      append_held(terrain, (north + static_cast<double>(i)) * spacing_m,
                  (east + static_cast<double>(j)) * spacing_m, answers);
  }
}

// Returns why the whole batch cannot be answered; Refusal::kNone when it can.
RayAnswers refusal_of(const std::string& terrain_version, const RayBatch& batch) {
  const std::size_t count = batch.rays.size();
  if (batch.mode > QueryMode::kDepthTiles)
    return refused(Refusal::kBadQuery, "query_mode is none of the four");
  if (count == 0) return refused(Refusal::kBadQuery, "there is no ray");
  const std::size_t max_count = kMaxRays / results_a_ray(batch.mode);
  if (count > max_count) {
    return refused(Refusal::kTooMany,
                   "there are " + std::to_string(count) + " rays; allowed are " + std::to_string(max_count));
  }
  const bool spacing_possible = std::isfinite(batch.sample_spacing_m) && batch.sample_spacing_m > 0;
  if (batch.mode == QueryMode::kDepthTiles && !spacing_possible)
    return refused(Refusal::kBadQuery, "sample_spacing_m must be above 0");
  if (!batch.expected_terrain.empty() && batch.expected_terrain != terrain_version) {
    return refused(Refusal::kOtherTerrain, "the terrain served is another");
  }
  return {};
}

}  // namespace

RayAnswers answer(const Terrain& terrain, const std::string& terrain_version, const RayBatch& batch) {
  RayAnswers answers = refusal_of(terrain_version, batch);
  if (answers.refusal != Refusal::kNone) return answers;
  const std::size_t results = batch.rays.size() * results_a_ray(batch.mode);
  answers.statuses.reserve(results);
  answers.results_m.reserve(results);
  if (batch.mode == QueryMode::kDepth) {
    for (const Ray& ray : batch.rays)
      append_depth(terrain, ray.origin_ned_m.x(), ray.origin_ned_m.y(), answers);
    return answers;
  }
  if (batch.mode == QueryMode::kDepthTiles) {
    for (const Ray& ray : batch.rays) append_tile(terrain, ray.origin_ned_m, batch.sample_spacing_m, answers);
    return answers;
  }
  // Occlusion is answered by the closest hit: the search along the ray ends at the first one.
  for (const RayHit& hit : terrain.closest_hits(batch.rays)) append(answers, hit.status, hit.range_m);
  return answers;
}

}  // namespace halocline::bathymetry
