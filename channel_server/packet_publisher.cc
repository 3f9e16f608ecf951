// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packet_publisher.h"

#include <string>
#include <variant>

#include "bus/messages/channels.h"
#include "channel_server/messages/packet_messages.h"

namespace halocline::channel_server {

namespace channels = bus::channels;

namespace {

// Returns sender, session and sequence number of a packet.
std::string text_of(const SendRequest& request) {
  return request.vehicle + "/" + std::to_string(request.session) + "/" +
         std::to_string(request.packet_sequence);
}

}  // namespace

void PacketPublisher::publish(const MediumEvent& event) {
  if (const auto* receipt = std::get_if<Receipt>(&event.what)) {
    publish(*receipt, event.at);
  } else if (const auto* answer = std::get_if<ModemReply>(&event.what)) {
    const modem_reply_t message = to_message(*answer, event.at);
    journal_.publish_once(std::string(channels::kModemReply), message, identity_of(message));
  } else if (const auto* noticed = std::get_if<ModemEvent>(&event.what)) {
    const modem_event_t message = to_message(*noticed, event.at);
    journal_.publish_once(channels::kModemEvent.of(noticed->vehicle), message, identity_of(message));
  } else if (const auto* use = std::get_if<EnergyUse>(&event.what)) {
    const modem_energy_t message = to_message(*use, event.at);
    journal_.publish_once(channels::kModemEnergy.of(use->vehicle), message, identity_of(message));
  } else {
    publish(std::get<PacketOutcome>(event.what), event.at, event.late);
  }
}

void PacketPublisher::warn_of_terrain(PropagationUsed used) {
  if (used != PropagationUsed::kRaysBeyondTerrain || warned_of_terrain_) return;
  warned_of_terrain_ = true;
  bus_.log().warning("terrain-ends",
                     "reason=\"packets cross the end of the terrain or places without data\" "
                     "see=propagation.beyond");
}

// A repeated SEND gets its receipt again, except while recorded inputs are replayed.
void PacketPublisher::publish(const Receipt& receipt, SimTime at) {
  const std::string channel = channels::kReceipt.of(receipt.vehicle);
  const modem_receipt_t message = to_message(receipt, at);
  if (journal_.is_recovering()) {
    journal_.publish_once(channel, message, identity_of(message));
  } else {
    journal_.publish_again(channel, message, identity_of(message));
  }
}

void PacketPublisher::publish(const PacketOutcome& outcome, SimTime at, bool late) {
  warn_of_terrain(outcome.propagation);
  const std::string outcomes(channels::kOutcome);
  const packet_outcome_t message = to_outcome(outcome, at);
  const std::string identity = identity_of(message);
  // If an earlier incarnation published the outcome, it published the delivery before it, so nothing is
  // delivered again, whatever is decided now.
  if (outcome.deliver && !journal_.was_published(outcomes, identity)) {
    const modem_receive_t delivered = to_receive(outcome, at);
    journal_.publish_once(channels::kReceive.of(outcome.receiver), delivered, identity_of(delivered));
  }
  const std::int64_t late_before = bus_.counters().late;
  const bool is_new = journal_.publish_once(outcomes, message, identity);
  const bool is_counted = bus_.counters().late > late_before;  // the bus has counted it as late by CLOCK
  if (journal_.is_recovering()) {
    published_late_ += is_new ? 1 : 0;
    late = is_new;
  }
  if (is_new && outcome.conflicts_with_past) {
    bus_.log().warning("send-too-late",
                       "packet=" + text_of(outcome.packet->request) + " receiver=" + outcome.receiver +
                           " reason=\"an outcome that it would have changed was published before\"");
  }
  if (!is_counted && (late || (is_new && outcome.conflicts_with_past))) ++bus_.counters().late;
}

}  // namespace halocline::channel_server
