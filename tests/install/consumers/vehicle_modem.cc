// SPDX-License-Identifier: BSD-3-Clause
// Sends a packet by the modem library; what it publishes is received in the place of a channel server:
// vehicle_modem
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include <halocline/modem_send_t.hpp>

#include "bus/bus.h"
#include "clients/modem/modem_client.h"
#include "core/names.h"

struct Server {
  halocline::modem_send_t send{};
  void receive(const lcm::ReceiveBuffer*, const std::string&, const halocline::modem_send_t* message) {
    send = *message;
  }
};

int main() {
  lcm::LCM lcm("memq://");
  Server server;
  lcm.subscribe("SEND.auv-1", &Server::receive, &server);
  halocline::bus::Bus bus(lcm, {"vehicle", 1});
  halocline::clients::ModemClient modem(bus, {.vehicle = "auv-1", .vehicle_id = 1, .session = 7});
  const std::vector<std::uint8_t> payload{1, 2, 3};
  const std::int64_t sequence = modem.send({}, {}, halocline::kBroadcastId, payload);
  while (lcm.handleTimeout(0) > 0) {
  }
  std::printf("SEND of %d bytes by vehicle %d\n", server.send.payload_size, server.send.source_id);
  return modem.is_pending(sequence) && server.send.payload == payload && server.send.source_id == 1 ? 0 : 1;
}
