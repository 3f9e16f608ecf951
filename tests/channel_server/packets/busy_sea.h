// SPDX-License-Identifier: BSD-3-Clause
// A busy sea: twenty vehicles under way in a box of 6 km, random packets, pings, queues, silences, odd bands
// and families, modems that receive badly; every outcome occurs. All of it drawn by address, so a run is its
// seed and its length.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/link/ray_doppler.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/state_history.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/random.h"
#include "core/sim_time.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server::testing {

inline constexpr VehicleId kBusyVehicles = 20;
inline constexpr double kPacketsPerSecond = 10;

inline double busy_draw(const char* purpose, std::uint32_t who, std::uint64_t which) {
  return uniform_at({.seed = 5, .purpose = purpose_of(purpose), .who = who, .which = which});
}

// Three paths a link: the direct one (spherical spreading), and two echoes whose delays follow from the
// range; some pairs in a shadow, some behind terrain. Cheap, so that a test may evaluate it millions of
// times. With `fades` the echoes come off a moving surface.
class ThreePaths : public Propagation {
 public:
  explicit ThreePaths(bool fades = false) : fades_(fades) {}

  Reception reception(SimTime, const LinkEnd& from, const LinkEnd& to) override {
    Reception reception;
    auto& budget = reception.budget;
    budget.range_m = (to.position_ned_m - from.position_ned_m).norm();
    budget.delay_s = budget.range_m / kSpeedMps;
    budget.received_level = kSilence;
    const VehicleId pair = from.id * to.id % 41;
    if (pair == 1) reception.state = PathState::kShadow;
    if (pair == 2) reception.state = PathState::kBlocked;
    if (reception.state != PathState::kOpen) return reception;
    const Vec3 way = (to.position_ned_m - from.position_ned_m) / std::max(budget.range_m, 1.0);
    Arrival path;
    path.doppler_factor = acoustics::doppler_factor(from.velocity_ned_mps.dot(way), kSpeedMps,
                                                    to.velocity_ned_mps.dot(way), kSpeedMps);
    const double level_db = from.modem->source_level.value - 20 * std::log10(std::max(budget.range_m, 1.0));
    for (const auto& [longer_m, weaker_db] :
         {std::pair(0.0, 0.0), std::pair(9.0, 5.0), std::pair(60.0, 9.0)}) {
      path.delay_s = std::sqrt(std::pow(budget.range_m, 2) + std::pow(longer_m, 2) * 30) / kSpeedMps;
      path.level = {level_db - weaker_db};
      if (fades_) {
        path.identity.branch = static_cast<int>(reception.paths.size()) + 1;
        path.fading =
            acoustics::path_fading({.enabled = true}, 5, from.modem->centre_frequency_hz, 1e-5 * longer_m, 0);
      }
      reception.paths.push_back(path);
    }
    budget.received_level = total_level(reception.paths);
    reception.delay_spread_s = reception.paths.back().delay_s - reception.paths.front().delay_s;
    return reception;
  }
  const acoustics::Environment& environment(SimTime) const override { return water_; }

 private:
  bool fades_;
  acoustics::Environment water_ = even_water();
};

inline VehicleModem busy_modem(VehicleId id) {
  VehicleModem modem;
  modem.modem.source_level = {134};
  modem.modem.min_receivable_level = {id % 5 == 0 ? 66.0 : -100.0};
  modem.modem.bit_rate_bps = 5000;
  modem.modem.preamble = modem.modem.packet_overhead = for_s(0.005);
  modem.modem.doppler_tolerance = 0.003;
  modem.modem.guard_time = for_s(0.01);
  modem.when_busy = id % 2 == 0 ? WhenBusy::kQueue : WhenBusy::kRefuse;
  if (id == 7) modem.modem.centre_frequency_hz = 28'000;  // half of the others' band
  if (id == 13) modem.modem.centre_frequency_hz = 40'000;
  if (id == 17) modem.modem.family = "whistle";
  return modem;
}

inline ConfiguredModems busy_modems() {
  ConfiguredModems modems{busy_modem(1), {}};
  for (VehicleId id = 1; id <= kBusyVehicles; ++id) modems.of_vehicle.emplace(name_of(id), busy_modem(id));
  return modems;
}

struct TimedState {
  VehicleId id;
  StampedState state;
};

// Circles, once a second; every vehicle falls silent for 8 s of each 400 s, at times of its own.
inline std::vector<TimedState> busy_states(double until_s) {
  std::vector<TimedState> states;
  for (int second = 0; second <= static_cast<int>(until_s); ++second) {
    for (VehicleId id = 1; id <= kBusyVehicles; ++id) {
      if ((second + 37 * id) % 400 < 8) continue;
      const auto who = static_cast<std::uint32_t>(id);
      const double radius_m = 50 + 300 * busy_draw("radius", who, 0),
                   speed_mps = 1 + 2.5 * busy_draw("speed", who, 0);
      const double rate = speed_mps / radius_m, angle = rate * second + id;
      const Vec3 centre(6000 * busy_draw("north", who, 0), 6000 * busy_draw("east", who, 0), 30.0 + 10 * id);
      states.push_back({id,
                        {at_s(second), centre + radius_m * Vec3(std::cos(angle), std::sin(angle), 0),
                         speed_mps * Vec3(-std::sin(angle), std::cos(angle), 0)}});
    }
  }
  return states;
}

inline std::vector<SendRequest> busy_requests(std::size_t count) {
  std::vector<SendRequest> requests;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto source = static_cast<VehicleId>(1 + busy_draw("source", 0, i) * kBusyVehicles);
    const double start_s = 1 + busy_draw("start", 0, i) * static_cast<double>(count) / kPacketsPerSecond;
    auto request = request_of(source, start_s, static_cast<std::int64_t>(i),
                              static_cast<std::size_t>(busy_draw("bytes", 0, i) * 70));
    request.destination_id = static_cast<VehicleId>(busy_draw("to", 0, i) * (kBusyVehicles + 1));
    if (i % 16 == 0 && request.destination_id != 0) request.kind = PacketKind::kPing;
    requests.push_back(request);
  }
  return requests;
}

template <class Item>
void shuffle(std::vector<Item>& items, std::uint32_t turn) {
  for (std::size_t i = items.size(); i > 1; --i) {
    std::swap(items[i - 1],
              items[static_cast<std::size_t>(busy_draw("shuffle", turn, i) * static_cast<double>(i))]);
  }
}

struct BusyRun {
  std::size_t packets = 1000;
  std::uint32_t turn = 0;  // decides the order in which states and requests are handed in; 0: by time
  double step_s = 1;       // of advance_to
  std::uint64_t seed = 1;
  bool fades = false;
};

// Runs it, every event given to `visit`, and returns the fleet for questions of who was there. In order of
// time everything is handed in as it happens; shuffled, all of it before time runs.
template <class Visitor>
VehicleRegistry run_busy_sea(const BusyRun& run, Visitor&& visit) {
  const double until_s = static_cast<double>(run.packets) / kPacketsPerSecond + 30;
  VehicleRegistry fleet({for_s(0.05), for_s(5)}, busy_modems());
  ThreePaths propagation(run.fades);
  MediumRule rule{for_s(10), for_s(until_s), run.seed};
  rule.fading.enabled = run.fades;
  PacketMedium medium(fleet, propagation, rule);
  auto states = busy_states(until_s);
  auto requests = busy_requests(run.packets);
  if (run.turn > 0) shuffle(states, run.turn), shuffle(requests, run.turn);
  for (const auto& timed : states) EXPECT_EQ(fleet.add_state(name_of(timed.id), timed.id, timed.state), "");
  for (const auto& request : requests) EXPECT_FALSE(medium.transmit(request, SimTime()));
  for (double t = 0; t <= until_s; t += run.step_s) {
    for (const MediumEvent& event : medium.advance_to(at_s(t))) visit(event);
    medium.forget_before(at_s(t - 11));
  }
  EXPECT_EQ(medium.packets_in_flight(), 0u);
  return fleet;
}

}  // namespace halocline::channel_server::testing
