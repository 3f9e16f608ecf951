// SPDX-License-Identifier: BSD-3-Clause
// Answers each packet that a vehicle receives, by the modem library: echo-modem VEHICLE ID
//
// Another program moves the vehicle: the vehicle simulator, or one that publishes STATE.VEHICLE.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <random>

#include "bus/transport/transport.h"
#include "clients/modem/blocking_modem.h"
#include "core/sim_time.h"

using halocline::SimDuration;

namespace {

void answer_all(const char* vehicle, int id) {
  const auto lcm = halocline::bus::open_transport(halocline::bus::effective_url(""));  // LCM_DEFAULT_URL
  const std::int64_t session = std::random_device()() + 1LL;  // differs at each start
  halocline::clients::BlockingModem modem(*lcm, {.vehicle = vehicle, .vehicle_id = id, .session = session});
  while (const auto packet = modem.wait_receive(SimDuration::from_seconds(120))) {
    std::printf("%.3f s: %d bytes from vehicle %d, %.1f dB SNR\n", static_cast<double>(packet->utime) * 1e-6,
                packet->payload_size, packet->source_id, packet->snr_db);
    const auto answer = modem.send(packet->source_id, packet->payload);
    if (!answer) continue;  // no CLOCK: the run has ended
    const auto receipt = modem.wait_receipt(*answer, SimDuration::from_seconds(2));
    if (receipt && receipt->receipt_result == halocline::modem_receipt_t::ACCEPTED) {
      std::printf("answered; the modem transmits for %.3f s\n", receipt->duration_s);
    } else {
      std::puts("not answered: refused, or no receipt");
    }
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: echo-modem VEHICLE ID\n", stderr);
    return 2;
  }
  try {
    answer_all(argv[1], std::atoi(argv[2]));
    return 0;
  } catch (const std::exception& error) {  // an invalid name, or the network cannot be used
    std::fprintf(stderr, "echo-modem: %s\n", error.what());
    return dynamic_cast<const halocline::bus::NetworkError*>(&error) != nullptr ? 69 : 2;
  }
}
