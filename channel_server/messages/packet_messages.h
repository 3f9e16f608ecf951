// SPDX-License-Identifier: BSD-3-Clause
// Conversion to messages and back of transmissions, receipts, outcomes and events of packets. The publisher
// sets session and sequence.
#pragma once

#include <string>
#include <string_view>

#include "bus/messages/messages.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

SendRequest to_request(std::string_view vehicle, const modem_send_t& message);
modem_reply_t to_message(const ModemReply& answer, SimTime at);
ModemReply to_answer(const modem_reply_t& message);

modem_receipt_t to_message(const Receipt& receipt, SimTime answered_at);
packet_outcome_t to_outcome(const PacketOutcome& outcome, SimTime at);
modem_event_t to_message(const ModemEvent& event, SimTime at);
modem_energy_t to_message(const EnergyUse& use, SimTime at);
// Returns the RECEIVE message of an outcome; requires an outcome with `deliver`.
modem_receive_t to_receive(const PacketOutcome& outcome, SimTime at);

// Return what distinguishes an output from all others on its channel, whichever incarnation of the server
// computes it (bus/recovery/crash_journal.h).
std::string identity_of(const modem_receipt_t& message);
std::string identity_of(const modem_receive_t& message);
std::string identity_of(const packet_outcome_t& message);
std::string identity_of(const modem_reply_t& message);
std::string identity_of(const modem_event_t& message);
std::string identity_of(const modem_energy_t& message);

}  // namespace halocline::channel_server
