// Messages of the bus to what the pure part of the channel server knows, and back: total, no judgement beyond
// what the types force.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acoustics/sea/boundary_reflection.h"
#include "bus/messages.h"
#include "channel_server/links/link_query_service.h"
#include "channel_server/links/link_table.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/packets/packet.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/vehicles/vehicle_registry.h"

namespace halocline::channel_server {

// What ENVIRONMENT tells beside the water.
struct WaterDescription {
  std::string propagation;                       // "straight", "rays"
  std::optional<acoustics::FluidBottom> bottom;  // with rays
  std::optional<acoustics::SurfaceModel> surface;
};

StampedState to_state(const vehicle_state_t& message);

// A modem that acoustics/modem/modem.h refuses throws InvalidArgument.
VehicleModem to_modem(const modem_config_t& message);
modem_config_t to_message(const VehicleModem& modem, SimTime from);

SendRequest to_request(std::string_view vehicle, const modem_send_t& message);
ping_answer_t to_message(const PingAnswer& answer, SimTime at);
PingAnswer to_answer(const ping_answer_t& message);

// Session and sequence are the publisher's to fill in.
modem_receipt_t to_message(const Receipt& receipt, SimTime answered_at);
packet_outcome_t to_outcome(const PacketEnd& end, SimTime at);
// Only for an end that is to be delivered.
modem_receive_t to_receive(const PacketEnd& end, SimTime at);

// What tells an output from all others on its channel, whichever incarnation of the server computes it
// (bus/runtime/crash_journal.h).
std::string identity_of(const modem_receipt_t& message);
std::string identity_of(const modem_receive_t& message);
std::string identity_of(const packet_outcome_t& message);
std::string identity_of(const ping_answer_t& message);

link_t to_message(const LinkRow& row);
link_table_t to_message(const LinkTable& table, SimTime at);

// An end that cannot be read (a modem with a NaN) carries the problem.
LinkQuestion to_question(const link_query_t& message);
link_reply_t to_message(const LinkReply& reply);

ray_query_t to_message(const RayBatch& batch, std::string_view client, SimTime asked_at);
std::vector<RayAnswer> to_answers(const ray_reply_t& message);

// The profile at the depths of its rows (of more than 2000, every second, third, ...); of a formula, every
// 100 m down to 5000 m.
environment_t to_message(const acoustics::Environment& environment, const WaterDescription& description,
                         SimTime from, const std::string& terrain_version);

// What is set, on top of `before`, whose formula of sound speed stays. Throws InvalidArgument when the profile is
// impossible.
EnvironmentChange to_change(const environment_change_t& message, const acoustics::Environment& before);

}  // namespace halocline::channel_server
