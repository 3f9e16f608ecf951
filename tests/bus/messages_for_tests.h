// Messages for the tests of the bus: one valid message of each type, with arrays of a size drawn by seed.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "bus/messages.h"

namespace halocline::bus::testing {

// Every type of the bus, to run a test over.
using AllMessages =
    std::tuple<sim_clock_t, vehicle_state_t, vehicle_command_t, vehicle_sensors_t, vehicle_dvl_t,
               vehicle_gps_t, vehicle_sonar_t, vehicle_usbl_t, vehicle_fault_t, current_change_t,
               environment_t, environment_change_t, modem_config_t, modem_send_t, modem_receipt_t,
               modem_receive_t, packet_name_t, packet_outcome_t, position_estimate_t, link_t, link_table_t,
               link_end_t, link_query_t, link_answer_t, link_reply_t, ray_query_t, ray_reply_t, node_status_t,
               flow_heartbeat_t, repair_request_t, ping_answer_t, lockstep_message_t, lockstep_turn_t,
               lockstep_result_t, lockstep_grant_t, lockstep_answer_t, lockstep_join_t, lockstep_notice_t>;

// A message that passes every check; the same for the same seed. Seed 0 has empty arrays where a type allows
// them.
template <class Message>
Message valid_message(unsigned seed);

}  // namespace halocline::bus::testing
