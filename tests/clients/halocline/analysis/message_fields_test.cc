// The names that visit_fields gives must be those of lcmtypes/, in their order.
#include "clients/halocline/analysis/message_fields.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace halocline::clients {
namespace {

struct NameCollector {
  std::string names;
  template <class T>
  void operator()(const char* name, const T&) {
    names += std::string(name) + " ";
  }
};

// The fields of a type file: the last word of each statement that is no constant, without its dimensions.
std::string names_in_file(const std::string& type) {
  std::ifstream in(std::string(HALOCLINE_SOURCE_DIR) + "/lcmtypes/" + type + ".lcm");
  std::string text, line, names;
  while (std::getline(in, line)) text += line.substr(0, line.find("//")) + "\n";
  std::istringstream statements(text.substr(text.find('{') + 1));
  for (std::string statement; std::getline(statements, statement, ';');) {
    std::istringstream words(statement.substr(0, statement.find('[')));
    std::string first, name;
    if (words >> first >> name && first != "const" && first != "}") names += name + " ";
  }
  return names;
}

template <class Message>
void expect_same(const std::string& type) {
  NameCollector collector;
  visit_fields(collector, Message{});
  EXPECT_EQ(collector.names, names_in_file(type)) << type;
}

TEST(MessageFields, AreThoseOfTheTypes) {
  expect_same<current_change_t>("current_change_t");
  expect_same<environment_t>("environment_t");
  expect_same<flow_heartbeat_t>("flow_heartbeat_t");
  expect_same<link_answer_t>("link_answer_t");
  expect_same<link_end_t>("link_end_t");
  expect_same<link_query_t>("link_query_t");
  expect_same<link_reply_t>("link_reply_t");
  expect_same<link_t>("link_t");
  expect_same<link_table_t>("link_table_t");
  expect_same<modem_config_t>("modem_config_t");
  expect_same<modem_receipt_t>("modem_receipt_t");
  expect_same<modem_receive_t>("modem_receive_t");
  expect_same<modem_send_t>("modem_send_t");
  expect_same<node_status_t>("node_status_t");
  expect_same<packet_name_t>("packet_name_t");
  expect_same<packet_outcome_t>("packet_outcome_t");
  expect_same<ping_answer_t>("ping_answer_t");
  expect_same<position_estimate_t>("position_estimate_t");
  expect_same<ray_query_t>("ray_query_t");
  expect_same<ray_reply_t>("ray_reply_t");
  expect_same<repair_request_t>("repair_request_t");
  expect_same<sim_clock_t>("sim_clock_t");
  expect_same<vehicle_command_t>("vehicle_command_t");
  expect_same<vehicle_dvl_t>("vehicle_dvl_t");
  expect_same<vehicle_fault_t>("vehicle_fault_t");
  expect_same<vehicle_gps_t>("vehicle_gps_t");
  expect_same<vehicle_sensors_t>("vehicle_sensors_t");
  expect_same<vehicle_sonar_t>("vehicle_sonar_t");
  expect_same<vehicle_state_t>("vehicle_state_t");
  expect_same<vehicle_usbl_t>("vehicle_usbl_t");
}

}  // namespace
}  // namespace halocline::clients
