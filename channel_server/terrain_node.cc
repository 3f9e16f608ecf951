// How the channel server asks the bathymetry service, and takes its answers.
#include <utility>

#include "bus/channels.h"
#include "channel_server/channel_server_messages.h"
#include "channel_server/channel_server_node.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

std::string in_base_36(std::uint64_t number) {
  std::string digits;
  do {
    digits += "0123456789abcdefghijklmnopqrstuvwxyz"[number % 36];
    number /= 36;
  } while (number != 0);
  return {digits.rbegin(), digits.rend()};
}

}  // namespace

// 13 digits of base 36 hold every session; the name has 24 characters at most.
std::string ChannelServerNode::ray_client_name(std::int64_t session) {
  return "channel-" + in_base_36(static_cast<std::uint64_t>(session));
}

void ChannelServerNode::take_ray_replies() {
  for (const ray_reply_t& reply : std::exchange(ray_replies_, {})) {
    if (reply.terrain_version != terrain_version_) {
      forget_echoes();
      terrain_version_ = reply.terrain_version;
      next_environment_ = kBeforeAll;
    }
    if (reply.reply_status == ray_reply_t::OK) {
      asker_.answer(reply.request_id, to_answers(reply));
    } else {
      bus().refuse(channels::kRayReply.of(ray_client_), "the service refused: " + reply.refusal);
      asker_.refuse(reply.request_id);
    }
  }
  take_finished_surveys();
}

// Those of another terrain; what is being asked is answered by a mixture of the two.
void ChannelServerNode::forget_echoes() {
  if (terrain_version_.empty()) return;
  book_.clear();
  bottoms_->clear();
  surveyed_pairs_.clear();
}

void ChannelServerNode::take_finished_surveys() {
  for (RayQueryClient::Finished& finished : asker_.take_finished()) {
    if (desk_.finish(finished)) continue;
    const auto pair = surveyed_pairs_.extract(finished.id);
    if (pair.empty()) continue;
    book_.note_asked(pair.mapped());
    bottoms_->note_asked(pair.mapped());
    if (!finished.answered) continue;
    if (auto* echoes = std::get_if<EchoSurvey>(&finished.survey)) {
      book_.store(pair.mapped(), std::move(*echoes));
    } else {
      bottoms_->store(pair.mapped(), std::get<ProfileSurvey>(finished.survey));
    }
  }
}

void ChannelServerNode::ask_for_echoes(const std::vector<PlacedVehicle>& vehicles) {
  for (const VehiclePair& pair : book_.begin_tick(vehicles, rules_.medium.shard)) {
    const EchoSurvey survey(book_.place(pair.first), book_.place(pair.second), rules_.bottom_points);
    surveyed_pairs_.emplace(asker_.ask_routine(survey), pair);
  }
}

void ChannelServerNode::ask_for_profiles(const std::vector<PlacedVehicle>& vehicles) {
  for (const VehiclePair& pair : bottoms_->take_geometry(vehicles, rules_.medium.shard)) {
    surveyed_pairs_.emplace(asker_.ask_routine(bottoms_->survey_of(pair)), pair);
  }
}

void ChannelServerNode::ask_terrain(const bus::Now& now) {
  for (const RayBatch& batch : asker_.take_batches(now.steady)) {
    bus().publish(channels::kRayQuery, to_message(batch, ray_client_, now.sim));
  }
  take_finished_surveys();
  if (asker_.is_away() == told_away_) return;
  told_away_ = asker_.is_away();
  if (told_away_) {
    bus().log().warning("bathymetry-away", propagation_->uses_bottom() ? "paths=straight multipath=unknown"
                                                                       : "multipath=unknown");
  } else {
    bus().log().info("bathymetry-back");
  }
}

}  // namespace halocline::channel_server
