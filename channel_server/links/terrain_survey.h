// SPDX-License-Identifier: BSD-3-Clause
// A survey of the terrain in one or more queries: it names the kind and the rays of its next query and takes
// their answers.
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

// Returns the kind of the next query; empty after the last.
inline std::optional<RayKind> next_query(const TerrainSurvey& survey) {
  return std::visit([](const auto& one) { return one.next_query(); }, survey);
}
// Returns the rays of that query.
inline std::vector<TerrainRay> rays_of(const TerrainSurvey& survey) {
  return std::visit([](const auto& one) { return one.rays(); }, survey);
}
// Takes as many answers as those rays need.
inline void take(TerrainSurvey& survey, std::span<const RayAnswer> answers) {
  std::visit([&](auto& one) { one.take(answers); }, survey);
}

}  // namespace halocline::channel_server
