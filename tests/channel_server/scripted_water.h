// SPDX-License-Identifier: BSD-3-Clause
// A propagation whose paths are written down link by link, and a bench of still vehicles around a medium:
// what decides a packet's outcome can then be set one by one.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/modem/bit_error.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server::testing {

inline Arrival path(double delay_s, double level_db, double doppler_factor = 1) {
  Arrival sound;
  sound.delay_s = delay_s;
  sound.level = {level_db};
  sound.doppler_factor = doppler_factor;
  return sound;
}

// What the quick modem (800 bit/s in 5 kHz, non-coherent FSK) does with a bit at this ratio.
inline double bit_error(double sinr) {
  return acoustics::bit_error_rate(quick_modem().modem, PowerRatio{sinr});
}

// The level, dB, at which `error` of the bits are wrong in noise alone: exp(-Eb/2N0)/2 solved for S.
inline double level_with_bit_error(double error, double noise_power) {
  const double eb_over_n0 = -2 * std::log(2 * error);
  return 10 * std::log10(eb_over_n0 * 800 / 5000 * noise_power);
}

class ScriptedPropagation : public Propagation {
 public:
  // Paths by delay; without any, silence for the reason given.
  void set(VehicleId from, VehicleId to, std::vector<Arrival> paths, PathState state = PathState::kOpen) {
    links_[{from, to}] = {std::move(paths), state};
  }
  // A link that is not set is in a shadow, one second away.
  Reception reception(SimTime, const LinkEnd& from, const LinkEnd& to) override {
    ++calls;
    Reception reception;
    reception.state = PathState::kShadow;
    reception.used = PropagationUsed::kRays;
    if (const auto link = links_.find({from.id, to.id}); link != links_.end()) {
      std::tie(reception.paths, reception.state) = link->second;
    }
    auto& budget = reception.budget;
    budget.delay_s =
        reception.paths.empty() ? 1 : reception.paths[first_significant(reception.paths)].delay_s;
    budget.received_level = total_level(reception.paths);
    budget.range_m = (to.position_ned_m - from.position_ned_m).norm();
    reception.delay_spread_s = channel_server::delay_spread_s(reception.paths);
    return reception;
  }
  const acoustics::Environment& environment(SimTime) const override { return water_; }

  int calls = 0;

 private:
  acoustics::Environment water_ = even_water();
  std::map<std::pair<VehicleId, VehicleId>, std::pair<std::vector<Arrival>, PathState>> links_;
};

// Four still vehicles, 1 to 4, present for two minutes from second 0 on.
class ScriptedWater : public ::testing::Test {
 protected:
  ScriptedWater() {
    for (VehicleId id = 1; id <= 4; ++id)
      move_steadily(fleet, id, {1000.0 * id, 0, 50}, Vec3::Zero(), 0, 120);
  }
  void send(const SendRequest& request) { EXPECT_FALSE(medium.transmit(request, SimTime())); }
  // `bytes` take 10 ms each with the quick modem.
  void send(VehicleId source, double start_s, std::int64_t sequence, std::size_t bytes) {
    send(request_of(source, start_s, sequence, bytes));
  }
  void run(double until_s = 110) {
    for (const MediumEvent& event : medium.advance_to(at_s(until_s))) events.push_back(event);
  }
  // Of the packet that `source` called `sequence`, at `receiver`.
  const PacketOutcome& end_of(VehicleId source, std::int64_t sequence, VehicleId receiver,
                              PacketKind kind = PacketKind::kData) {
    for (const MediumEvent& event : events) {
      const auto* end = std::get_if<PacketOutcome>(&event.what);
      if (end && end->packet->request.source_id == source && end->receiver_id == receiver &&
          end->packet->request.packet_sequence == sequence && end->packet->request.kind == kind) {
        return *end;
      }
    }
    throw std::runtime_error("no end of packet " + std::to_string(sequence));
  }
  SendResult result_of(std::int64_t sequence) {
    for (const Receipt& receipt : receipts_in(events)) {
      if (receipt.packet_sequence == sequence) return receipt.result;
    }
    throw std::runtime_error("no receipt of packet " + std::to_string(sequence));
  }
  using Colliders = std::vector<std::pair<VehicleId, std::int64_t>>;  // source and sequence number
  static Colliders colliders_of(const PacketOutcome& end) {
    Colliders names;
    for (const PacketName& name : end.statistics.colliders)
      names.emplace_back(name.source_id, name.packet_sequence);
    return names;
  }
  // These vehicles carry the big modem, but for `change`.
  void change_modem(const std::vector<VehicleId>& ids, const std::function<void(acoustics::Modem&)>& change) {
    VehicleModem modem = big_modem();
    change(modem.modem);
    for (const VehicleId id : ids) fleet.announce_modem(name_of(id), at_s(0), modem, at_s(0));
  }
  static VehicleModem big_modem() {
    VehicleModem modem = quick_modem();
    modem.max_payload_bytes = 32'768;
    return modem;
  }
  // uPa^2 over the band of the quick modem.
  static double noise_power() {
    const auto band = acoustics::Modem{}.band();
    return acoustics::noise_power_over_band(band.low_hz, band.high_hz, even_water().noise).value;
  }
  static double power_of(double level_db) { return to_power_ratio(Decibels{level_db}).value; }

  VehicleRegistry fleet{{for_s(0.05), for_s(5)}, {big_modem(), {}}};
  ScriptedPropagation water;
  PacketMedium medium{fleet, water, {for_s(10), for_s(200)}};
  std::vector<MediumEvent> events;
};

}  // namespace halocline::channel_server::testing
