// SPDX-License-Identifier: BSD-3-Clause
// Messages of a small run, made by hand.
#pragma once

#include <cstdint>
#include <string>

#include "bus/messages/message_codec.h"
#include "runs/timeline/run_timeline.h"

namespace halocline::clients::testing {

constexpr std::int64_t kSecond = 1'000'000;

inline vehicle_state_t state(std::int32_t id, std::int64_t utime, double north_m, double east_m = 0,
                             double down_m = 0) {
  vehicle_state_t s{};
  s.utime = utime;
  s.vehicle_id = id;
  s.position_ned_m[0] = north_m;
  s.position_ned_m[1] = east_m;
  s.position_ned_m[2] = down_m;
  s.orientation_wxyz[0] = 1;
  return s;
}

inline modem_send_t send(std::int32_t from, std::int64_t sequence, std::int64_t utime, std::int32_t to = 0) {
  modem_send_t s{};
  s.utime = utime;
  s.session = 7;
  s.packet_sequence = sequence;
  s.source_id = from;
  s.destination_id = to;
  s.payload_size = 3;
  s.payload = {1, 2, 3};
  return s;
}

inline modem_receipt_t receipt(std::int64_t sequence, std::int64_t start_utime,
                               std::int8_t result = modem_receipt_t::ACCEPTED) {
  modem_receipt_t r{};
  r.utime = start_utime;
  r.send_session = 7;
  r.packet_sequence = sequence;
  r.receipt_result = result;
  const bool departs = result == modem_receipt_t::ACCEPTED || result == modem_receipt_t::QUEUED;
  r.start_utime = departs ? start_utime : 0;
  r.duration_s = departs ? 2 : 0;
  return r;
}

inline packet_outcome_t outcome(std::int32_t from, std::int32_t to, std::int64_t sequence,
                                std::int64_t departure_utime,
                                std::int8_t result = packet_outcome_t::RECEIVED) {
  packet_outcome_t o{};
  o.utime = departure_utime + 3 * kSecond;
  o.send_session = 7;
  o.packet_sequence = sequence;
  o.source_id = from;
  o.receiver_id = to;
  o.num_receivers = 1;
  o.outcome = result;
  o.departure_utime = departure_utime;
  o.travel_time_s = 1;
  o.duration_s = 2;
  o.range_m = 1500;
  o.num_paths = 1;
  o.received_level_db = 100;
  o.transmission_loss_db = 65;
  o.noise_level_db = 90;
  o.snr_db = 10;
  o.cutoff_level_db = 80;
  o.interference_level_db = -300;
  o.strongest_path_doppler_factor = 1;
  return o;
}

template <class Message>
void add(RunTimeline& store, const std::string& channel, const Message& message) {
  store.add(message.utime, channel, bus::encoded(message));
}

}  // namespace halocline::clients::testing
