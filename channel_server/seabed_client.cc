// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/seabed_client.h"

#include <utility>

#include "bus/messages/channels.h"
#include "channel_server/messages/link_messages.h"

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

SeabedClient::SeabedClient(bus::Bus& bus, SeabedMap& seabed, const Propagation& propagation)
    : bus_(bus),
      seabed_(seabed),
      propagation_(propagation),
      client_name_(client_name(bus.identity().session)) {
  bus_.subscribe<ray_reply_t>(channels::kRayReply.of(client_name_),
                              [this](const ray_reply_t& reply) { replies_.push_back(reply); });
}

// 13 digits of base 36 hold every session; a client name has at most 24 characters.
std::string SeabedClient::client_name(std::int64_t session) {
  return "channel-" + in_base_36(static_cast<std::uint64_t>(session));
}

// Tiles in progress belong to the earlier terrain, too.
bool SeabedClient::take_replies() {
  bool is_other_terrain = false;
  has_news_ = false;
  for (const ray_reply_t& reply : std::exchange(replies_, {})) {
    if (reply.terrain_version != terrain_version_) {
      if (!terrain_version_.empty()) clear();
      terrain_version_ = reply.terrain_version;
      is_other_terrain = true;
    }
    if (reply.reply_status == ray_reply_t::OK) {
      rays_.answer(reply.request_id, to_answers(reply));
    } else {
      bus_.refuse(channels::kRayReply.of(client_name_), "the service refused: " + reply.refusal);
      rays_.refuse(reply.request_id);
    }
  }
  take_finished_tiles();
  return is_other_terrain;
}

void SeabedClient::take_finished_tiles() {
  for (const RayQueryClient::Finished& finished : rays_.take_finished()) {
    if (finished.answered) {
      seabed_.store(finished.tile);
    } else {
      seabed_.note_failed(finished.tile);
    }
    has_news_ = true;
  }
}

void SeabedClient::publish_queries(const bus::Now& now) {
  retry_failed_tiles(now.steady);
  for (TileSurvey& tile : seabed_.take_requests()) rays_.submit(std::move(tile));
  for (const RayQueryBatch& batch : rays_.take_batches(now.steady)) {
    bus_.publish(channels::kRayQuery, to_message(batch, client_name_, now.sim));
  }
  take_finished_tiles();
  report_presence();
}

void SeabedClient::ask_for_terrain() { rays_.probe(TileSurvey({}, seabed_.rule().spacing_m)); }

void SeabedClient::retry_failed_tiles(SimTime steady) {
  const bool is_back = reported_away_ && !rays_.is_away();
  if (steady < next_retry_ && !is_back) return;
  next_retry_ = steady + kRetryPeriod;
  seabed_.forget_failures();
}

void SeabedClient::report_presence() {
  const bool is_away = rays_.is_away();
  if (is_away == std::exchange(reported_away_, is_away)) return;
  if (is_away) {
    bus_.log().warning("bathymetry-unavailable",
                       propagation_.uses_bottom() ? "paths=straight multipath=unknown" : "multipath=unknown");
  } else {
    bus_.log().info("bathymetry-back");
  }
}

void SeabedClient::clear() {
  rays_.clear();
  seabed_.clear();
}

std::string SeabedClient::status_text() const {
  const std::string service = rays_.is_away()            ? "away"
                              : terrain_version_.empty() ? "not present"
                                                         : "answering";
  return "bathymetry " + service + ", " + std::to_string(rays_.counters().tiles_failed) + " tiles failed";
}

}  // namespace halocline::channel_server
