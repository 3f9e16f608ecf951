// What makes a decoded message impossible: NaN, infinities, enumerations without a meaning, sizes, names and
// times out of range. One overload a type; each returns an empty string, or the field and what it may hold.
//
// A message that fails is counted, reported with channel and reason, and ignored; never repaired, never
// guessed. What only a model can judge (a position beyond the terrain, a modem too weak) is the business of
// its node.
#pragma once

#include <string>

#include "bus/messages.h"

namespace halocline::bus {

std::string problem_in(const sim_clock_t& message);
std::string problem_in(const vehicle_state_t& message);
std::string problem_in(const vehicle_command_t& message);
std::string problem_in(const vehicle_sensors_t& message);
std::string problem_in(const vehicle_dvl_t& message);
std::string problem_in(const vehicle_gps_t& message);
std::string problem_in(const vehicle_sonar_t& message);
std::string problem_in(const vehicle_usbl_t& message);
std::string problem_in(const vehicle_fault_t& message);
std::string problem_in(const current_change_t& message);
std::string problem_in(const environment_t& message);
std::string problem_in(const environment_change_t& message);
std::string problem_in(const modem_config_t& message);
std::string problem_in(const modem_send_t& message);
std::string problem_in(const modem_receipt_t& message);
std::string problem_in(const modem_receive_t& message);
std::string problem_in(const packet_name_t& message);
std::string problem_in(const packet_outcome_t& message);
std::string problem_in(const ping_answer_t& message);
std::string problem_in(const position_estimate_t& message);
std::string problem_in(const link_t& message);
std::string problem_in(const link_table_t& message);
// A query's ends are judged one by one by the server, which answers BAD_INPUT for those that cannot be; here
// only what concerns the query as a whole (client name, count).
std::string problem_in(const link_query_t& message);
std::string problem_in(const link_reply_t& message);
// Rays are judged one by one by the service (BAD_INPUT); a query as a whole is refused by it with a reason,
// so here only what would leave it unanswerable (client name, a NaN base).
std::string problem_in(const ray_query_t& message);
std::string problem_in(const ray_reply_t& message);
std::string problem_in(const node_status_t& message);
std::string problem_in(const flow_heartbeat_t& message);
std::string problem_in(const repair_request_t& message);
// Lockstep's own plane; what slices hold is checked when they are whole (lockstep_wire.h).
std::string problem_in(const lockstep_message_t& message);
std::string problem_in(const lockstep_turn_t& message);
std::string problem_in(const lockstep_result_t& message);
std::string problem_in(const lockstep_grant_t& message);
std::string problem_in(const lockstep_answer_t& message);
std::string problem_in(const lockstep_join_t& message);
std::string problem_in(const lockstep_notice_t& message);

}  // namespace halocline::bus
