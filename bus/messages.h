// All types of the bus, as lcm-gen made them.
#pragma once

#include <halocline/current_change_t.hpp>
#include <halocline/environment_change_t.hpp>
#include <halocline/environment_t.hpp>
#include <halocline/flow_heartbeat_t.hpp>
#include <halocline/link_answer_t.hpp>
#include <halocline/link_end_t.hpp>
#include <halocline/link_query_t.hpp>
#include <halocline/link_reply_t.hpp>
#include <halocline/link_t.hpp>
#include <halocline/link_table_t.hpp>
#include <halocline/modem_config_t.hpp>
#include <halocline/modem_receipt_t.hpp>
#include <halocline/modem_receive_t.hpp>
#include <halocline/modem_send_t.hpp>
#include <halocline/node_status_t.hpp>
#include <halocline/packet_name_t.hpp>
#include <halocline/packet_outcome_t.hpp>
#include <halocline/position_estimate_t.hpp>
#include <halocline/ray_query_t.hpp>
#include <halocline/ray_reply_t.hpp>
#include <halocline/repair_request_t.hpp>
#include <halocline/sim_clock_t.hpp>
#include <halocline/vehicle_command_t.hpp>
#include <halocline/vehicle_sensors_t.hpp>
#include <halocline/vehicle_state_t.hpp>
