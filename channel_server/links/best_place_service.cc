// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/best_place_service.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "channel_server/links/link_query_service.h"
#include "channel_server/links/waiting_queries.h"
#include "core/names.h"

namespace halocline::channel_server {
namespace {

bool is_better(const PlaceScore& a, const PlaceScore& b) {
  return a.mean_delivery != b.mean_delivery ? a.mean_delivery > b.mean_delivery
                                            : a.mean_sinr_db > b.mean_sinr_db;
}

// Returns the score of one place from its forecasts to all listeners.
PlaceScore score_of(const LinkForecast* forecasts, std::size_t count) {
  PlaceScore score{.least_delivery = 1, .mean_sinr_db = 0, .in_water = true};
  for (std::size_t i = 0; i < count; ++i) {
    const LinkForecast& forecast = forecasts[i];
    score.mean_delivery += forecast.delivery_probability / static_cast<double>(count);
    score.least_delivery = std::min(score.least_delivery, forecast.delivery_probability);
    score.mean_sinr_db += forecast.sinr_db / static_cast<double>(count);
  }
  score.mean_delivery = std::min(score.mean_delivery, 1.0);  // the sum of shares may exceed 1 by rounding
  return score;
}

}  // namespace

std::optional<std::size_t> best_of(const std::vector<PlaceScore>& scores) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i].in_water && (!best || is_better(scores[i], scores[*best]))) best = i;
  }
  return best;
}

BestPlaceService::BestPlaceService(const VehicleRegistry& fleet, Propagation& propagation,
                                   LinkPredictor& predictor, ReceiverNoise& noise, SimDuration timeout,
                                   ForEach for_each)
    : fleet_(fleet),
      propagation_(propagation),
      predictor_(predictor),
      noise_(noise),
      timeout_(timeout),
      for_each_(std::move(for_each)) {}

void BestPlaceService::submit(const BestPlaceQuery& query, std::optional<SimTime> sim, SimTime steady) {
  if (is_among(waiting_, query)) return;
  Waiting waiting;
  waiting.reply = {query.client, query.request_id, {}, refusal_of(query, sim), {}};
  waiting.deadline = steady + timeout_;
  if (waiting.reply.refusal.empty()) {
    waiting.reply.at = std::clamp(query.at.value_or(*sim), *sim - kMaxTimeOffset, *sim + kMaxTimeOffset);
    waiting.reply.refusal = resolve(query, waiting);
  }
  waiting_.push_back(std::move(waiting));
}

std::string BestPlaceService::refusal_of(const BestPlaceQuery& query, std::optional<SimTime> sim) const {
  const std::size_t places = query.places_ned_m.size(), listeners = query.listeners.size();
  if (places < 1 || listeners < 1 || places > kMaxLinks || listeners > kMaxLinks ||
      places * listeners > kMaxLinks)
    return std::to_string(places) + " places times " + std::to_string(listeners) +
           " listeners; allowed is 1 to " + std::to_string(kMaxLinks) + " together, 1 and up of each";
  if (!sim) return "no simulation time is known yet";
  if (waiting_.size() >= kMaxWaiting) return "too many queries are waiting; try again later";
  return {};
}

std::string BestPlaceService::resolve(const BestPlaceQuery& query, Waiting& waiting) const {
  const SimTime at = waiting.reply.at;
  waiting.places_ned_m = query.places_ned_m;
  waiting.talker = fleet_.configured_modems().standard;
  if (!query.talker.empty()) {
    if (!is_valid_name(query.talker)) return "talker_name is no name: " + std::string(kNameRule);
    waiting.talker = fleet_.modem(query.talker, at);
    waiting.talker_id = fleet_.id_of(query.talker).value_or(0);
  }
  for (const std::string& name : query.listeners) {
    if (!is_valid_name(name)) return "a listener_name is no name: " + std::string(kNameRule);
    if (name == query.talker) return "the listener " + name + " is the talker itself";
    const auto id = fleet_.id_of(name);
    const auto place = id ? fleet_.placement(*id, at, at) : std::nullopt;
    if (!place) return "the listener " + name + " is unknown, or its state is too old";
    waiting.listeners.push_back(
        {{*id, place->position_ned_m, place->velocity_ned_mps, nullptr}, fleet_.modem(*id, at)});
  }
  return {};
}

bool BestPlaceService::is_in_water(const Vec3& place_ned_m, SimTime at) const {
  return problem_of_place(propagation_, place_ned_m, at).empty() &&
         propagation_.depth_inside_seabed_m(place_ned_m) <= kSeabedErrorM;
}

std::vector<EndPair> BestPlaceService::links_of(const Waiting& waiting,
                                                const std::vector<bool>& in_water) const {
  std::vector<EndPair> links;
  for (std::size_t i = 0; i < in_water.size(); ++i) {
    if (!in_water[i]) continue;
    const Vec3& place = waiting.places_ned_m[i];
    for (const Listener& listener : waiting.listeners) {
      LinkEnd to = listener.end;
      to.modem = &receiving_modem(listener.modem, waiting.talker.modem);
      links.push_back({{0, place, Vec3::Zero(), &waiting.talker.modem}, to});
    }
  }
  return links;
}

bool BestPlaceService::answer(Waiting& waiting, bool is_overdue) {
  const SimTime at = waiting.reply.at;
  std::vector<bool> in_water;
  for (const Vec3& place : waiting.places_ned_m) in_water.push_back(is_in_water(place, at));
  std::vector<EndPair> links = links_of(waiting, in_water);
  NoiseOfLinks noise(noise_, at, waiting.talker_id);
  // Every link is asked, so that all missing data are requested together.
  bool are_ready = noise.are_ready(links);
  for (const EndPair& link : links)
    are_ready = propagation_.is_ready_for_packet(at, link.from, link.to) && are_ready;
  if (!are_ready && !is_overdue) return false;
  for (EndPair& link : links) noise.set(link);
  std::vector<std::optional<Reception>> receptions = propagation_.packet_receptions(at, links, for_each_);
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!receptions[i])
      receptions[i] = propagation_.reception_without_capacity(at, links[i].from, links[i].to);
  }
  const auto rates = predictor_.rates_of(waiting.talker.modem);
  const SlowState slow = predictor_.slow_state(0, 0, at);  // the places hold no vehicles
  std::vector<LinkForecast> forecasts(links.size());
  for_each_(links.size(), [&](std::size_t i) {
    forecasts[i] =
        predictor_.forecast(*rates, *links[i].from.modem, *links[i].to.modem, *receptions[i], slow);
    if (receptions[i]->paths.empty()) forecasts[i].sinr_db = kSilence.value;
  });
  const std::size_t listeners = waiting.listeners.size();
  const LinkForecast* next = forecasts.data();
  for (const bool is_scored : in_water) {
    waiting.reply.scores.push_back(is_scored ? score_of(next, listeners) : PlaceScore());
    if (is_scored) next += listeners;
  }
  return true;
}

std::vector<BestPlaceReply> BestPlaceService::take_replies(SimTime steady) {
  std::vector<BestPlaceReply> replies;
  std::erase_if(waiting_, [&](Waiting& waiting) {
    if (waiting.reply.refusal.empty() && !answer(waiting, steady >= waiting.deadline)) return false;
    replies.push_back(std::move(waiting.reply));
    return true;
  });
  return replies;
}

SimTime BestPlaceService::due() const {
  SimTime due = SimTime::never();
  for (const Waiting& waiting : waiting_) due = std::min(due, waiting.deadline);
  return due;
}

}  // namespace halocline::channel_server
