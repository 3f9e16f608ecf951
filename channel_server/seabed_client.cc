// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/seabed_client.h"

#include <utility>
#include <variant>

#include "bus/messages/channels.h"
#include "channel_server/link_messages.h"
#include "channel_server/links/echo_survey.h"
#include "channel_server/propagation/seabed_map.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

constexpr SimDuration kRetryPeriod = SimDuration::from_milliseconds(1000);

std::string in_base_36(std::uint64_t number) {
  std::string digits;
  do {
    digits += "0123456789abcdefghijklmnopqrstuvwxyz"[number % 36];
    number /= 36;
  } while (number != 0);
  return {digits.rbegin(), digits.rend()};
}

}  // namespace

SeabedClient::SeabedClient(bus::Bus& bus, Models models, int bottom_points, EchoRule echoes, Shard shard)
    : bus_(bus),
      models_(models),
      bottom_points_(bottom_points),
      plan_(echoes),
      shard_(std::move(shard)),
      client_name_(client_name(bus.identity().session)) {
  bus_.subscribe<ray_reply_t>(channels::kRayReply.of(client_name_),
                              [this](const ray_reply_t& reply) { replies_.push_back(reply); });
}

// 13 digits of base 36 hold every session; a client name has at most 24 characters.
std::string SeabedClient::client_name(std::int64_t session) {
  return "channel-" + in_base_36(static_cast<std::uint64_t>(session));
}

bool SeabedClient::take_replies(LinkQueryService& queries) {
  bool is_other_terrain = false;
  has_news_ = false;
  for (const ray_reply_t& reply : std::exchange(replies_, {})) {
    if (reply.terrain_version != terrain_version_) {
      forget_terrain();
      terrain_version_ = reply.terrain_version;
      is_other_terrain = true;
    }
    if (reply.reply_status == ray_reply_t::OK) {
      models_.rays.answer(reply.request_id, to_answers(reply));
    } else {
      bus_.refuse(channels::kRayReply.of(client_name_), "the service refused: " + reply.refusal);
      models_.rays.refuse(reply.request_id);
    }
  }
  take_finished_surveys(queries);
  return is_other_terrain;
}

// Surveys in progress are dropped, too: their answers would mix the two terrains.
void SeabedClient::forget_terrain() {
  if (terrain_version_.empty()) return;
  models_.echoes.clear();
  models_.seabed.clear();
  plan_.clear();
  surveyed_pairs_.clear();
  surveyed_tiles_.clear();
}

void SeabedClient::take_finished_surveys(LinkQueryService& queries) {
  for (RayQueryClient::Finished& finished : models_.rays.take_finished()) {
    if (queries.finish(finished)) continue;
    if (surveyed_tiles_.erase(finished.id) > 0) {
      const TileSurvey& tile = std::get<TileSurvey>(finished.survey);
      if (finished.answered) {
        models_.seabed.store(tile);
      } else {
        models_.seabed.note_failed(tile);
      }
      has_news_ = true;
      continue;
    }
    const auto pair = surveyed_pairs_.extract(finished.id);
    if (pair.empty()) continue;
    if (finished.answered)
      models_.echoes.store(pair.mapped(), std::move(std::get<EchoSurvey>(finished.survey)));
    else
      plan_.note_unanswered(pair.mapped());
  }
}

void SeabedClient::begin_tick(const std::vector<PlacedVehicle>& vehicles, const std::vector<EndPair>& links) {
  models_.seabed.forget_unused();
  for (const RayQueryClient::SurveyId dropped : models_.rays.begin_tick()) {
    const auto pair = surveyed_pairs_.extract(dropped);
    if (!pair.empty()) plan_.note_unanswered(pair.mapped());
  }
  if (models_.propagation.uses_bottom()) return;  // rays include the echoes of the bottom
  models_.echoes.begin_tick(vehicles);
  for (const auto& [pair, low_ned_m, high_ned_m] : plan_.begin_tick(links)) {
    if (!shard_.serves(pair.first) && !shard_.serves(pair.second)) continue;
    const EchoSurvey survey(low_ned_m, high_ned_m, bottom_points_);
    surveyed_pairs_.emplace(models_.rays.submit_routine(survey), pair);
  }
}

void SeabedClient::publish_queries(const bus::Now& now, LinkQueryService& queries) {
  retry_failed_tiles(now.steady);
  for (const TileSurvey& tile : models_.seabed.take_requests()) {
    surveyed_tiles_.insert(models_.rays.submit_urgent(tile));
  }
  for (const RayQueryBatch& batch : models_.rays.take_batches(now.steady)) {
    bus_.publish(channels::kRayQuery, to_message(batch, client_name_, now.sim));
  }
  take_finished_surveys(queries);
  report_presence();
}

void SeabedClient::ask_for_terrain() {
  models_.rays.probe(EchoSurvey(Vec3::Zero(), Vec3::Zero(), bottom_points_));
}

void SeabedClient::retry_failed_tiles(SimTime steady) {
  const bool is_back = reported_away_ && !models_.rays.is_away();
  if (steady < next_retry_ && !is_back) return;
  next_retry_ = steady + kRetryPeriod;
  models_.seabed.forget_failures();
}

void SeabedClient::report_presence() {
  const bool is_away = models_.rays.is_away();
  if (is_away == std::exchange(reported_away_, is_away)) return;
  if (is_away) {
    bus_.log().warning("bathymetry-away", models_.propagation.uses_bottom()
                                              ? "paths=straight multipath=unknown"
                                              : "multipath=unknown");
  } else {
    bus_.log().info("bathymetry-back");
  }
}

void SeabedClient::clear() {
  models_.rays.clear();
  models_.echoes.clear();
  models_.seabed.clear();
  plan_.clear();
  surveyed_pairs_.clear();
  surveyed_tiles_.clear();
}

std::string SeabedClient::status_text() const {
  const RayQueryClient::Counters& counters = models_.rays.counters();
  const std::string service = models_.rays.is_away()     ? "away"
                              : terrain_version_.empty() ? "not present"
                                                         : "answering";
  return "bathymetry " + service + ", " + std::to_string(plan_.deferred()) + " echo surveys put off, " +
         std::to_string(counters.surveys_dropped) + " dropped, " + std::to_string(counters.surveys_failed) +
         " failed";
}

}  // namespace halocline::channel_server
