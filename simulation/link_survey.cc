// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/link_survey.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/reverberation.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/link/received_field.h"
#include "acoustics/modem/modem.h"
#include "acoustics/noise/place_noise.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/noise.h"
#include "acoustics/sea/published_range.h"
#include "bathymetry/ray_service.h"
#include "bathymetry/terrain/terrain.h"
#include "bus/config/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/links/link_table.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/elementary.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "simulation/link_surveyor.h"

namespace halocline::clients {
namespace {

using channel_server::RayAnswer;

// The distance from its other end at which the straight line between two points ends for is_cut(), m: more
// than the error of a stored seabed, less than any relief that matters to sound.
constexpr double kShortOfEndM = 0.01;

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

std::vector<RayAnswer> query(const bathymetry::Terrain& terrain, bathymetry::QueryMode mode,
                             const bathymetry::Ray& ray, double spacing_m = 0) {
  const bathymetry::RayBatch batch{.mode = mode, .sample_spacing_m = spacing_m, .rays = {ray}};
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
    const auto number = parse_number(part);
    if (!number) return false;
    position[count] = *number;
  }
  return count == 3;
}

// Returns the eigenrays of measured taps. A measured level does not tell its causes apart: all of the loss
// counts as spreading.
acoustics::Eigenrays measured_eigenrays(const channel_server::Reception& reception, Decibels source_level) {
  acoustics::Eigenrays eigenrays;
  for (const acoustics::Arrival& tap : reception.paths) {
    acoustics::Eigenray path;
    path.delay_s = tap.delay_s;
    path.amplitude = elementary::exp10((tap.level - source_level).value / 20);
    path.phase_rad = tap.phase_rad;
    eigenrays.paths.push_back(path);
  }
  return eigenrays;
}

// Returns the eigenray of the single straight path. The transmission loss without absorption and beam
// patterns is its spreading loss:
//   amplitude = 10^((absorption_db + beam_loss_db - transmission_loss_db) / 20)
acoustics::Eigenrays straight_eigenray(const channel_server::Reception& reception,
                                       const acoustics::Transducers& beams) {
  acoustics::Eigenray path = reception.paths.front();
  const Decibels weighed =
      beams.source.loss(path.launch_angle_rad) + beams.receiver.loss(-path.arrival_angle_rad);
  path.amplitude =
      elementary::exp10((path.absorption_db + weighed.value - reception.budget.transmission_loss.value) / 20);
  return {.paths = {path}};
}

// Describes the paths of a reception, for any propagation model.
LinkArrivals link_arrivals(const ScenarioConfig& config, const LinkSurveyEnd& from, const LinkSurveyEnd& to,
                           const channel_server::Reception& reception, acoustics::Eigenrays eigenrays) {
  const Vec3 way = to.position_ned_m - from.position_ned_m;
  const double surface_z_m = config.scenario.surface_z_m(0);
  LinkArrivals all{
      .link = {depth_below_surface_m(from.position_ned_m, surface_z_m),
               depth_below_surface_m(to.position_ned_m, surface_z_m), elementary::hypot(way.x(), way.y())},
      .eigenrays = std::move(eigenrays)};
  all.modems_known = true;
  all.beams = {from.modem.modem.beam, to.modem.modem.beam};
  all.blocked = reception.state == channel_server::PathState::kBlocked;
  if (reception.measured)
    all.found_by = "measured";
  else if (!is_along_rays(reception.used))
    all.found_by = "straight";
  std::remove_copy_if(reception.paths.begin(), reception.paths.end(), std::back_inserter(all.received),
                      acoustics::is_reverberation);
  return all;
}

acoustics::PathLack lack_of(channel_server::PathState state) {
  if (state == channel_server::PathState::kTooWeak) return acoustics::PathLack::kTooWeak;
  if (state == channel_server::PathState::kTooSteep) return acoustics::PathLack::kTooSteep;
  return acoustics::PathLack::kShadow;
}

acoustics::Eigenrays eigenrays_of(const channel_server::Reception& reception,
                                  const acoustics::Modem& transmitter, const acoustics::Modem& receiver) {
  if (reception.measured) return measured_eigenrays(reception, transmitter.source_level);
  if (is_along_rays(reception.used)) {
    acoustics::Eigenrays eigenrays{reception.solver, {}, lack_of(reception.state)};
    std::remove_copy_if(reception.paths.begin(), reception.paths.end(), std::back_inserter(eigenrays.paths),
                        acoustics::is_reverberation);
    return eigenrays;
  }
  return reception.paths.empty() ? acoustics::Eigenrays()
                                 : straight_eigenray(reception, {transmitter.beam, receiver.beam});
}

// True when the terrain obstructs the straight line between two points; false where the terrain is not known.
bool is_cut(const bathymetry::Terrain& terrain, const Vec3& from_ned_m, const Vec3& to_ned_m) {
  const Vec3 way = to_ned_m - from_ned_m;
  const double length = way.norm() - kShortOfEndM;
  if (length <= 0) return false;
  return query(terrain, bathymetry::QueryMode::kOccluded, {from_ned_m, way, length}).front().kind ==
         RayAnswer::Kind::kHit;
}

// Returns remarks that a reader of the prediction needs.
std::vector<std::string> notes_of(const ScenarioConfig& config, const bathymetry::Terrain& terrain,
                                  const LinkSurveyEnd& from, const LinkSurveyEnd& to,
                                  LinkSurveyor& surveyor) {
  const acoustics::Environment& environment = surveyor.propagation().environment(SimTime());
  std::vector<std::string> notes = acoustics::beyond_published_ranges(
      environment, from.modem.modem.band(),
      std::max(depth_below_surface_m(from.position_ned_m, environment.sea_surface_z_m),
               depth_below_surface_m(to.position_ned_m, environment.sea_surface_z_m)));
  if (!surveyor.along_rays() && is_cut(terrain, from.position_ned_m, to.position_ned_m))
    notes.emplace_back(
        "the terrain stands in the straight line: propagation.model = straight knows no terrain");
  const bool has_position = from.id == 0 || to.id == 0;
  if (has_position && config.channel_server.propagation.replay.is_wanted())
    notes.emplace_back("measured channels apply between vehicles alone: a link with a position is modelled");
  return notes;
}

}  // namespace

std::string noise_place_text(const ScenarioConfig& config) {
  const acoustics::NoiseSources noise = noise_sources(config.channel_server.environment);
  if (noise.table) return {};
  if (noise.site) return "as measured (site_noise)";
  if (noise.place == acoustics::NoisePlace::kOpen) return {};
  return std::string(to_name(noise.place)) + ", +-" + format_number(acoustics::kPlaceSpreadDb) +
         " dB from place to place";
}

Vec3 parse_vector(const std::string& text, const std::string& what) {
  Vec3 vector;
  require(parse_position(text, vector), what + " is '" + text + "'; allowed is north,east,down");
  return vector;
}

LinkSurveyEnd link_end(const ScenarioConfig& config, const std::string& text) {
  const auto modems = make_modems(config.channel_server);
  LinkSurveyEnd end{.name = text, .modem = modems.standard};
  if (const bus::VehicleEntry* vehicle = config.scenario.find(text)) {
    end.position_ned_m = config.scenario.start_ned_m(*vehicle);
    end.id = vehicle->id;
    end.modem = modems.of(text);
  } else {
    require(parse_position(text, end.position_ned_m),
            "'" + text +
                "' is no link end; allowed is the name of a vehicle of the scenario, or "
                "north,east,down in metres");
  }
  require(depth_below_surface_m(end.position_ned_m, config.scenario.surface_z_m(0)) >= 0,
          "'" + text + "' lies above the sea surface");
  return end;
}

std::optional<double> seabed_z_m(const bathymetry::Terrain& terrain, const Vec3& place_ned_m) {
  const auto depth = terrain.held_depth_at(place_ned_m.x(), place_ned_m.y());
  return depth ? std::optional(depth->z_m) : std::nullopt;
}

void require_above_seabed(const bathymetry::Terrain& terrain, const LinkSurveyEnd& end) {
  const auto seabed_m = seabed_z_m(terrain, end.position_ned_m);
  require(!seabed_m || end.position_ned_m.z() <= *seabed_m,
          "'" + end.name + "' lies inside the seabed: z is " + format_number(end.position_ned_m.z()) +
              " m, that of the seabed there " + format_number(std::round(100 * seabed_m.value_or(0)) / 100) +
              " m");
}

void answer_requests(const bathymetry::Terrain& terrain, channel_server::SeabedMap& seabed) {
  for (channel_server::TileSurvey& tile : seabed.take_requests()) {
    static_assert(bathymetry::kTileSide == channel_server::TileSurvey::kPoints);
    const bathymetry::Ray place{tile.points_ned_m().front(), Vec3::UnitZ(), 1};  // only the origin is read
    tile.take(query(terrain, bathymetry::QueryMode::kDepthTiles, place, tile.spacing_m()));
    seabed.store(tile);
  }
}

channel_server::EndPair ends_between(const LinkSurveyEnd& from, const LinkSurveyEnd& to) {
  const acoustics::Modem &transmitter = from.modem.modem, &receiver = receiving_modem(to.modem, transmitter);
  // The transmitter's id only selects the direction in which paths are searched, so a link to a position has
  // none.
  const channel_server::VehicleId from_id = to.id == 0 ? 0 : from.id;
  return {{from_id, from.position_ned_m, from.velocity_ned_mps, &transmitter},
          {to.id, to.position_ned_m, to.velocity_ned_mps, &receiver}};
}

double water_depth_m(const ScenarioConfig& config, const bathymetry::Terrain& terrain, const Vec3& one_ned_m,
                     const Vec3& other_ned_m) {
  const auto seabed_m = seabed_z_m(terrain, 0.5 * (one_ned_m + other_ned_m));
  return seabed_m ? *seabed_m - config.scenario.sea_surface_z_m : std::numeric_limits<double>::infinity();
}

LinkSurvey survey_link(const ScenarioConfig& config, const LinkSurveyEnd& from, const LinkSurveyEnd& to) {
  const auto terrain = make_terrain(config).terrain;
  require_above_seabed(*terrain, from);
  require_above_seabed(*terrain, to);
  const channel_server::EndPair link = ends_between(from, to);
  const acoustics::Modem &transmitter = *link.from.modem, &receiver = *link.to.modem;
  LinkSurveyor surveyor(config, terrain, read_water(config.channel_server, config.scenario));
  LinkSurvey answer;
  answer.notes = notes_of(config, *terrain, from, to, surveyor);
  auto [reception, forecast] = surveyor.survey(link.from, link.to);
  answer.reception = std::move(reception);
  answer.forecast = forecast;
  answer.arrivals = link_arrivals(config, from, to, answer.reception,
                                  eigenrays_of(answer.reception, transmitter, receiver));
  answer.arrivals.spreads = {answer.reception.delay_spread_s, answer.forecast.rms_delay_spread_s};
  answer.multipath = multipath_of(answer.reception, receiver.min_receivable_level);
  answer.noise_place = noise_place_text(config);
  if (answer.reception.used == channel_server::PropagationUsed::kRaysBeyondTerrain)
    answer.notes.emplace_back(answer.reception.state == channel_server::PathState::kNoTerrain
                                  ? "the terrain ends or has no data on the way: no sound passes there"
                                  : "the terrain ends or has no data on the way: its last depth is held");
  return answer;
}

}  // namespace halocline::clients
