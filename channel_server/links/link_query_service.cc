// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/link_query_service.h"

#include <algorithm>
#include <cmath>

#include "acoustics/modem/modem.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/links/waiting_queries.h"
#include "core/check.h"
#include "core/names.h"

namespace halocline::channel_server {
namespace {

// Largest coordinate of a position, m; a larger one is taken for a wrong unit. Vehicles have the same bound.
constexpr double kFarthestM = 1e7;

// Returns the sound speed from the surface to `deepest_m`: at even steps, and at the rows of the profile,
// between which it is linear, unless there are more than kMaxRows of them.
std::vector<acoustics::SpeedRow> column_of(const acoustics::SoundSpeedProfile& profile, double deepest_m) {
  constexpr int kSteps = 100;
  constexpr std::size_t kMaxRows = 150;
  const double bottom_m = std::clamp(deepest_m, 1.0, acoustics::kDeepestWater);
  std::set<double> depths;
  for (int step = 0; step <= kSteps; ++step) depths.insert(bottom_m * step / kSteps);
  const std::vector<double> rows = profile.row_depths_m();
  const auto end = std::upper_bound(rows.begin(), rows.end(), bottom_m);
  if (static_cast<std::size_t>(end - rows.begin()) <= kMaxRows) depths.insert(rows.begin(), end);
  std::vector<acoustics::SpeedRow> column;
  for (const double depth_m : depths) column.push_back({depth_m, profile.sound_speed_mps(depth_m)});
  return column;
}

std::string problem_of_modem(const acoustics::Modem& modem) {
  try {
    validate(modem);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return {};
}

}  // namespace

LinkQueryService::LinkQueryService(const VehicleRegistry& fleet, Propagation& propagation,
                                   LinkPredictor& predictor, ReceiverNoise& noise, SimDuration timeout)
    : fleet_(fleet), propagation_(propagation), predictor_(predictor), noise_(noise), timeout_(timeout) {}

void LinkQueryService::submit(const LinkQuery& query, std::optional<SimTime> sim, SimTime steady) {
  if (is_among(waiting_, query)) return;
  Waiting waiting;
  waiting.reply = {query.client, query.request_id, sim.value_or(SimTime()), refusal_of(query), {}};
  waiting.deadline = steady + timeout_;
  waiting.wants_paths = query.wants_paths;
  if (waiting.reply.refusal.empty()) {
    NoiseOfLinks noise(noise_, waiting.reply.at);
    for (std::size_t i = 0; i < query.transmitters.size(); ++i) {
      answer(resolve(query.transmitters[i], sim), resolve(query.receivers[i], sim), noise, waiting);
    }
  }
  waiting_.push_back(std::move(waiting));
}

std::string LinkQueryService::refusal_of(const LinkQuery& query) const {
  const std::size_t count = query.transmitters.size(), most = query.wants_paths ? 1 : kMaxLinks;
  if (count < 1 || count > most) {
    return "num_links is " + std::to_string(count) + "; allowed is 1" +
           (query.wants_paths ? " with wants_paths" : " to " + std::to_string(most));
  }
  if (waiting_.size() >= kMaxWaiting) return "too many queries are waiting; try again later";
  return {};
}

LinkQueryService::ResolvedEnd LinkQueryService::resolve(const LinkEndRequest& end,
                                                        std::optional<SimTime> sim) const {
  ResolvedEnd resolved;
  resolved.problem = end.problem;
  if (resolved.problem.empty() && end.modem) resolved.problem = problem_of_modem(end.modem->modem);
  if (resolved.problem.empty() && end.vehicle.empty())
    resolved.problem = problem_of_place(propagation_, end.position_ned_m, sim.value_or(SimTime()));
  if (!resolved.problem.empty()) {
    resolved.status = LinkAnswer::Status::kBadInput;
    return resolved;
  }
  if (!end.vehicle.empty()) return resolve_vehicle(end, sim);
  resolved.placement.position_ned_m = end.position_ned_m;
  resolved.modem = end.modem.value_or(fleet_.configured_modems().standard);
  return resolved;
}

LinkQueryService::ResolvedEnd LinkQueryService::resolve_vehicle(const LinkEndRequest& end,
                                                                std::optional<SimTime> sim) const {
  ResolvedEnd resolved;
  if (!is_valid_name(end.vehicle)) {
    resolved.status = LinkAnswer::Status::kBadInput;
    resolved.problem = "vehicle_name is no name: " + std::string(kNameRule);
    return resolved;
  }
  const auto id = fleet_.id_of(end.vehicle);
  const auto placement = id && sim ? fleet_.placement(*id, *sim, *sim) : std::nullopt;
  if (!placement) {
    resolved.status = LinkAnswer::Status::kUnknownVehicle;
    resolved.problem = end.vehicle + " is unknown, or its state is too old";
    return resolved;
  }
  resolved.id = *id;
  resolved.placement = *placement;
  resolved.modem = end.modem.value_or(fleet_.modem(*id, *sim));
  return resolved;
}

std::string problem_of_place(const Propagation& propagation, const Vec3& position_ned_m, SimTime at) {
  for (const double coordinate : position_ned_m) {
    if (!(std::abs(coordinate) <= kFarthestM)) return "position_ned_m is no position within 1e7 m";
  }
  const double depth_m = depth_below_surface_m(position_ned_m, propagation.environment(at).sea_surface_z_m);
  if (depth_m < 0) return "position_ned_m lies above the sea surface (z is down)";
  if (depth_m > acoustics::kDeepestWater) return "position_ned_m lies deeper than 12000 m";
  return {};
}

void LinkQueryService::answer(const ResolvedEnd& from, const ResolvedEnd& to, NoiseOfLinks& noise,
                              Waiting& waiting) {
  LinkAnswer answer;
  const ResolvedEnd& worse = from.status != LinkAnswer::Status::kAnswered ? from : to;
  answer.status = worse.status;
  if (answer.status != LinkAnswer::Status::kAnswered) {
    answer.problem = (&worse == &from ? "transmitter: " : "receiver: ") + worse.problem;
    waiting.reply.answers.push_back(std::move(answer));
    return;
  }
  answer.row.transmitter_id = from.id;
  answer.row.receiver_id = to.id;
  answer.row.transmitter_age = from.placement.age;
  answer.row.receiver_age = to.placement.age;
  set_reception(from, to, waiting.reply.at, noise, answer);
  waiting.reply.answers.push_back(answer);
  const bool refused = answer.status != LinkAnswer::Status::kAnswered;
  const bool waits = !refused && !is_ready(waiting.reply.at, link_of(from, to), noise);
  const std::size_t index = waiting.reply.answers.size() - 1;
  if (waits) waiting.bottoms.insert(index);
  if (waits || waiting.wants_paths) waiting.ends.emplace(index, std::pair(from, to));
}

// Both are asked, so that all missing data are requested together.
bool LinkQueryService::is_ready(SimTime at, const EndPair& link, NoiseOfLinks& noise) {
  const bool is_noise_ready = noise.are_ready({link});
  return propagation_.is_ready(at, link.from, link.to) && is_noise_ready;
}

// Vehicles are not checked: they rest on the terrain's seabed, which may lie below the smooth one of rays.
std::string LinkQueryService::problem_with_seabed(const ResolvedEnd& end) const {
  const double inside_m = end.id == 0 ? propagation_.depth_inside_seabed_m(end.placement.position_ned_m) : 0;
  if (inside_m <= kSeabedErrorM) return {};
  return "position_ned_m lies " + std::to_string(std::lround(inside_m)) + " m inside the seabed";
}

EndPair LinkQueryService::link_of(const ResolvedEnd& from, const ResolvedEnd& to) {
  return {link_end(from.placed()), receiving_end(to.placed(), from.modem.modem)};
}

void LinkQueryService::set_reception(const ResolvedEnd& from, const ResolvedEnd& to, SimTime at,
                                     NoiseOfLinks& noise, LinkAnswer& answer) {
  const std::string at_from = problem_with_seabed(from), at_to = problem_with_seabed(to);
  if (!at_from.empty() || !at_to.empty()) {
    answer = {LinkAnswer::Status::kBadInput,
              at_from.empty() ? "receiver: " + at_to : "transmitter: " + at_from,
              {}};
    return;
  }
  LinkRow& row = answer.row;
  const acoustics::Modem &transmitter = from.modem.modem, &receiver = receiving_modem(to.modem, transmitter);
  EndPair link = link_of(from, to);
  noise.set(link);
  const Reception reception = propagation_.reception(at, link.from, link.to);
  row.set(reception, predictor_.forecast(*predictor_.rates_of(transmitter), transmitter, receiver, reception,
                                         predictor_.slow_state(from.id, to.id, at)));
  row.multipath = multipath_of(reception, receiver.min_receivable_level);
}

void LinkQueryService::take_bottoms(Waiting& waiting) {
  NoiseOfLinks noise(noise_, waiting.reply.at);
  std::erase_if(waiting.bottoms, [&](std::size_t index) {
    const auto& [from, to] = waiting.ends.at(index);
    if (!is_ready(waiting.reply.at, link_of(from, to), noise)) return false;
    set_reception(from, to, waiting.reply.at, noise, waiting.reply.answers[index]);
    return true;
  });
}

std::vector<LinkReply> LinkQueryService::take_replies(SimTime steady) {
  std::vector<LinkReply> replies;
  std::erase_if(waiting_, [&](Waiting& waiting) {
    take_bottoms(waiting);
    if (!waiting.is_done() && steady < waiting.deadline) return false;
    if (waiting.wants_paths) add_details(waiting);
    replies.push_back(std::move(waiting.reply));
    return true;
  });
  return replies;
}

void LinkQueryService::add_details(Waiting& waiting) {
  const auto ends = waiting.ends.find(0);
  if (ends == waiting.ends.end() || waiting.reply.answers[0].status != LinkAnswer::Status::kAnswered) return;
  const auto& [from, to] = ends->second;
  LinkDetails details{from.modem.modem.source_level, to.modem.modem.directivity_index, {}, {}};
  details.chart = propagation_.chart(waiting.reply.at, link_end(from.placed()), link_end(to.placed()));
  double deepest_m = std::max(details.chart.link.source_depth_m, details.chart.link.receiver_depth_m);
  for (const acoustics::RayPoint& point : details.chart.seabed)
    deepest_m = std::max(deepest_m, point.depth_m);
  const Vec3& place = from.placed().placement.position_ned_m;
  details.water = column_of(
      environment_at(propagation_.environment(waiting.reply.at), place.x(), place.y()).profile, deepest_m);
  waiting.reply.details = std::move(details);
}

SimTime LinkQueryService::due() const {
  SimTime due = SimTime::never();
  for (const Waiting& waiting : waiting_) {
    due = std::min(due, waiting.is_done() ? SimTime::at_once() : waiting.deadline);
  }
  return due;
}

}  // namespace halocline::channel_server
