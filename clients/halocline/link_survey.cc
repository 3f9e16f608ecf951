#include "clients/halocline/link_survey.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "bathymetry/ray_service.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

using channel_server::RayAnswer;
using channel_server::TerrainRay;

RayAnswer::Kind kind_of(bathymetry::RayStatus status) {
  using Status = bathymetry::RayStatus;
  switch (status) {
    case Status::kHit:
      return RayAnswer::Kind::kHit;
    case Status::kMiss:
      return RayAnswer::Kind::kMiss;
    case Status::kOutside:
      return RayAnswer::Kind::kOutside;
    case Status::kNoData:
      return RayAnswer::Kind::kNoData;
    case Status::kStartedBelowBottom:
      return RayAnswer::Kind::kBelowBottom;
    case Status::kBadInput:
      break;
  }
  return RayAnswer::Kind::kBadInput;
}

std::vector<RayAnswer> ask(const bathymetry::Terrain& terrain, bathymetry::QueryMode mode,
                           const std::vector<TerrainRay>& rays) {
  if (rays.empty()) return {};
  bathymetry::RayBatch batch{.mode = mode};
  for (const TerrainRay& ray : rays)
    batch.rays.push_back({ray.origin_ned_m, ray.direction, ray.greatest_range_m});
  const auto answers = bathymetry::answer(terrain, bathymetry::version_text(terrain.version()), batch);
  std::vector<RayAnswer> out;
  for (std::size_t i = 0; i < answers.statuses.size(); ++i) {
    out.push_back({kind_of(answers.statuses[i]), answers.results_m[i]});
  }
  return out;
}

bool parse_position(const std::string& text, Vec3& position) {
  std::istringstream in(text);
  std::string part;
  int count = 0;
  for (; std::getline(in, part, ','); ++count) {
    if (count == 3) return false;
    const char* end = part.data() + part.size();
    const auto [stop, error] = std::from_chars(part.data(), end, position[count]);
    if (error != std::errc() || stop != end || !std::isfinite(position[count])) return false;
  }
  return count == 3;
}

}  // namespace

LinkEnd link_end(const ScenarioConfig& config, const std::string& text) {
  const auto modems = make_modems(config.channel_server);
  LinkEnd end{text, {}, modems.standard};
  if (const bus::VehicleEntry* vehicle = config.scenario.find(text)) {
    end.position_ned_m = vehicle->start_ned_m;
    end.modem = modems.of(text);
  } else {
    require(parse_position(text, end.position_ned_m),
            "'" + text +
                "' is no link end; allowed is the name of a vehicle of the scenario, or "
                "north,east,down in metres");
  }
  require(depth_below_surface_m(end.position_ned_m, config.scenario.sea_surface_z_m) >= 0,
          "'" + text + "' lies above the sea surface");
  return end;
}

channel_server::EchoSurvey survey_echoes(const bathymetry::Terrain& terrain, const Vec3& from_ned_m,
                                         const Vec3& to_ned_m, int bottom_points) {
  channel_server::EchoSurvey survey(from_ned_m, to_ned_m, bottom_points);
  survey.take_depths(ask(terrain, bathymetry::QueryMode::kDepth, survey.depth_rays()));
  survey.take_ways(ask(terrain, bathymetry::QueryMode::kOccluded, survey.way_rays()));
  return survey;
}

LinkAnswer survey_link(const ScenarioConfig& config, const LinkEnd& from, const LinkEnd& to) {
  channel_server::StraightPropagation propagation(
      make_environment(config.channel_server.environment, config.scenario, config.folder));
  LinkAnswer answer;
  answer.budget = propagation
                      .reception(SimTime(), {0, from.position_ned_m, Vec3::Zero(), &from.modem.modem},
                                 {0, to.position_ned_m, Vec3::Zero(), &to.modem.modem})
                      .budget;
  const auto survey = survey_echoes(*make_terrain(config).terrain, from.position_ned_m, to.position_ned_m,
                                    config.channel_server.rules.bottom_points);
  answer.multipath = multipath_of(survey, /*reversed=*/false, propagation, from.modem.modem, to.modem.modem);
  return answer;
}

}  // namespace halocline::clients
