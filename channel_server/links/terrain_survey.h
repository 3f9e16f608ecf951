// SPDX-License-Identifier: BSD-3-Clause
// Surveys of the terrain in one or more queries: each has the kind and the rays of its next query, and takes
// the answers.
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "channel_server/links/echo_survey.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/terrain_rays.h"

namespace halocline::channel_server {

using TerrainSurvey = std::variant<EchoSurvey, TileSurvey>;

// The kind of its next query; empty after the last.
inline std::optional<RayKind> next_query(const TerrainSurvey& survey) {
  return std::visit([](const auto& one) { return one.next_query(); }, survey);
}
// The rays of that query.
inline std::vector<TerrainRay> rays_of(const TerrainSurvey& survey) {
  return std::visit([](const auto& one) { return one.rays(); }, survey);
}
// As many answers as there are to those rays.
inline void take(TerrainSurvey& survey, std::span<const RayAnswer> answers) {
  std::visit([&](auto& one) { one.take(answers); }, survey);
}

}  // namespace halocline::channel_server
