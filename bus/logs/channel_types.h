// Which type travels on which channel, for programs that read any channel: logs, statistics, tables.
#pragma once

#include <string_view>

#include "bus/bus.h"

namespace halocline::clients {

// Calls `f.template operator()<Message>()` with the type of `channel`; returns false for a channel that is
// none of ours.
template <class Function>
bool with_type_of(std::string_view channel, Function&& f) {
  namespace c = bus::channels;
  const auto is = [&](std::string_view name) { return channel == name; };
  const auto in = [&](const bus::Family& family) {
    return channel.starts_with(family.prefix) && is_valid_name(channel.substr(family.prefix.size()));
  };
  if (is(c::kClock)) return f.template operator()<sim_clock_t>(), true;
  if (is(c::kEnvironment)) return f.template operator()<environment_t>(), true;
  if (is(c::kSetEnvironment)) return f.template operator()<environment_change_t>(), true;
  if (is(c::kOutcome)) return f.template operator()<packet_outcome_t>(), true;
  if (is(c::kPingAnswer)) return f.template operator()<ping_answer_t>(), true;
  if (is(c::kLinkQuery)) return f.template operator()<link_query_t>(), true;
  if (is(c::kRayQuery)) return f.template operator()<ray_query_t>(), true;
  if (is(c::kSetCurrent)) return f.template operator()<current_change_t>(), true;
  if (in(c::kState)) return f.template operator()<vehicle_state_t>(), true;
  if (in(c::kSensors)) return f.template operator()<vehicle_sensors_t>(), true;
  if (in(c::kDvl)) return f.template operator()<vehicle_dvl_t>(), true;
  if (in(c::kGps)) return f.template operator()<vehicle_gps_t>(), true;
  if (in(c::kSonar)) return f.template operator()<vehicle_sonar_t>(), true;
  if (in(c::kUsbl)) return f.template operator()<vehicle_usbl_t>(), true;
  if (in(c::kFault)) return f.template operator()<vehicle_fault_t>(), true;
  if (in(c::kCommand)) return f.template operator()<vehicle_command_t>(), true;
  if (in(c::kModem)) return f.template operator()<modem_config_t>(), true;
  if (in(c::kSend)) return f.template operator()<modem_send_t>(), true;
  if (in(c::kReceipt)) return f.template operator()<modem_receipt_t>(), true;
  if (in(c::kReceive)) return f.template operator()<modem_receive_t>(), true;
  if (in(c::kEstimate)) return f.template operator()<position_estimate_t>(), true;
  if (in(c::kLinks)) return f.template operator()<link_table_t>(), true;
  if (in(c::kLinkReply)) return f.template operator()<link_reply_t>(), true;
  if (in(c::kRayReply)) return f.template operator()<ray_reply_t>(), true;
  if (in(c::kHeartbeat)) return f.template operator()<flow_heartbeat_t>(), true;
  if (is(c::kRepairRequest)) return f.template operator()<repair_request_t>(), true;
  if (channel.starts_with(c::kRepair.prefix))
    return with_type_of(channel.substr(c::kRepair.prefix.size()), f);
  if (in(c::kStatus)) return f.template operator()<node_status_t>(), true;
  return false;
}

// The channel's family: what comes before the dot of a family's channel, the whole name otherwise.
std::string_view family_of(std::string_view channel);

// Decodes bytes as bus::Bus does, without counting or reporting; false when they are no sound Message.
template <class Message>
bool decode_checked(const std::vector<std::uint8_t>& bytes, Message& message) {
  return bus::decode(bytes, message).empty();
}

}  // namespace halocline::clients
