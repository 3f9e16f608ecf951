// Whatever is found out of the terrain in one or more questions: each survey says what it asks next, gives the
// rays, and takes the answers.
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "channel_server/links/echo_survey.h"
#include "channel_server/propagation/profile_survey.h"

namespace halocline::channel_server {

using TerrainSurvey = std::variant<EchoSurvey, ProfileSurvey>;

// What it asks next; empty when it is through.
inline std::optional<RayKind> asks(const TerrainSurvey& survey) {
  return std::visit([](const auto& one) { return one.asks(); }, survey);
}
// The rays of that question.
inline std::vector<TerrainRay> rays_of(const TerrainSurvey& survey) {
  return std::visit([](const auto& one) { return one.rays(); }, survey);
}
// As many answers as rays.
inline void take(TerrainSurvey& survey, std::span<const RayAnswer> answers) {
  std::visit([&](auto& one) { one.take(answers); }, survey);
}

}  // namespace halocline::channel_server
