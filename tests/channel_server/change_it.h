// SPDX-License-Identifier: BSD-3-Clause
// A weak link and a packet over it in a small world, all numbers that the channel server publishes of them,
// and claims about how each moves: for tests that turn one input alone.
//
// The link is 800 m long, at a depth of 50 m over 200 m of water, and so weak that the packet is acquired and
// right with probabilities well inside 0..1: they show what moves them.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/sea/environment.h"
#include "acoustics/sea/noise.h"
#include "bus/transport/event_log.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/frames.h"
#include "tests/channel_server/node_bench.h"
#include "tests/channel_server/water_models.h"

namespace halocline::channel_server::testing {

inline constexpr double kAt = 3;  // s: table and packet
inline constexpr double kRangeM = 800;
inline constexpr std::int32_t kBytes = 10;
// Of packets with this number the draws are 0.41 (acquired) and 0.56 (right), so that outcomes move with the
// probabilities.
inline constexpr std::int64_t kSequence = 5;

// Before the first late echo comes a packet along rays has the noise alone against it.
constexpr double preamble_s(bool rays) { return rays ? 0.0008 : 0.0033; }

constexpr double bit_rate_bps(bool rays) { return rays ? 500 : 640; }

inline VehicleModem weak_modem(bool rays) {
  VehicleModem modem = quick_modem();
  modem.modem.source_level = {rays ? 125.0 : 106.8};
  modem.modem.min_receivable_level = {0};
  modem.modem.guard_taper = SimDuration();  // an echo is signal or interference
  modem.modem.bit_rate_bps = bit_rate_bps(rays);
  modem.modem.preamble = modem.modem.packet_overhead = for_s(preamble_s(rays));
  return modem;
}

struct World {
  explicit World(bool by_rays = false) : rays(by_rays), modem(weak_modem(by_rays)) {}
  bool rays;
  acoustics::Environment water = even_water();
  RayModel model;
  double bottom_z_m = 200;
  VehicleModem modem;
  std::int32_t bytes = kBytes;
  Vec3 a{0, 0, 50}, b{kRangeM, 0, 50};  // at kAt
  Vec3 velocity_of_a = Vec3::Zero(), velocity_of_b = Vec3::Zero();
};

// Of the link from a to b and of a packet that leaves a at kAt, by name.
using Numbers = std::map<std::string, double>;

inline Numbers numbers_of(const link_t& row) {
  return {{"link range", row.range_m},
          {"link delay", row.first_path_delay_s},
          {"link loss", row.transmission_loss_db},
          {"link level", row.received_level_db},
          {"link noise", row.noise_level_db},
          {"link snr", row.snr_db},
          {"link paths", row.num_paths},
          {"link spread", row.delay_spread_s},
          {"link doppler", row.first_path_doppler_factor},
          {"capacity", row.capacity_bps},
          {"receivable", row.receivable},
          {"path state", row.path_state},
          {"propagation", row.propagation_used}};
}
inline Numbers numbers_of(const packet_outcome_t& packet) {
  return {{"packet range", packet.range_m},
          {"packet delay", packet.travel_time_s},
          {"packet loss", packet.transmission_loss_db},
          {"packet level", packet.received_level_db},
          {"packet noise", packet.noise_level_db},
          {"packet snr", packet.snr_db},
          {"packet paths", packet.num_paths},
          {"packet spread", packet.delay_spread_s},
          {"packet doppler", packet.strongest_path_doppler_factor},
          {"duration", packet.duration_s},
          {"cutoff", packet.cutoff_level_db},
          {"interference", packet.interference_level_db},
          {"sinr", packet.sinr_db},
          {"acquisition", packet.acquisition_probability},
          {"success", packet.success_probability},
          {"acquisition draw", packet.acquisition_draw},
          {"success draw", packet.success_draw},
          {"azimuth", packet.arrival_azimuth_rad},
          {"elevation", packet.arrival_elevation_rad},
          {"colliders", packet.num_colliders},
          {"outcome", packet.outcome}};
}

inline Numbers numbers_of(const World& world) {
  bus::set_log_level(bus::LogLevel::kSilent);
  ServerRules rules;
  rules.reach.by_level = false;  // rows of the weakest links, too
  NodeBench bench(rules, {world.modem, {}},
                  world.rays ? ray_model(world.water, world.model, {}) : straight_model(world.water));
  FlatBottom bottom(bench.lcm(), world.bottom_z_m);
  for (double t = 0; t <= 8; t += 0.25) {  // steps and speeds that binary holds: places at kAt are exact
    bench.state(1, t, world.a + (t - kAt) * world.velocity_of_a, world.velocity_of_a);
    bench.state(2, t, world.b + (t - kAt) * world.velocity_of_b, world.velocity_of_b);
  }
  bench.send(1, kAt, kSequence, world.bytes);
  bench.run_to(kAt);
  Numbers numbers = numbers_of(bench.last_table(1).peers.at(0));
  bench.run_to(7);
  numbers.merge(numbers_of(bench.outcomes.at(0)));
  return numbers;
}

// What one output, or that of link and packet both ("level"), is to do.
struct Move {
  std::string output;
  std::function<void(double before, double after)> check;
};
using Moves = std::vector<Move>;

inline Move rises(const std::string& output) {
  return {output, [](double before, double after) { EXPECT_GT(after, before); }};
}
inline Move falls(const std::string& output) {
  return {output, [](double before, double after) { EXPECT_LT(after, before); }};
}
inline Move changes(const std::string& output) {
  return {output, [](double before, double after) { EXPECT_NE(after, before); }};
}
inline Move moves_by(const std::string& output, double amount, double tolerance = 1e-9) {
  return {output, [=](double before, double after) { EXPECT_NEAR(after - before, amount, tolerance); }};
}
inline Move becomes(const std::string& output, double value, double tolerance = 0) {
  return {output, [=](double before, double after) {
            EXPECT_NE(after, before);
            EXPECT_NEAR(after, value, tolerance);
          }};
}
inline Moves operator+(Moves some, const Moves& more) {
  some.insert(some.end(), more.begin(), more.end());
  return some;
}

inline World with_receiver_at(World world, const Vec3& velocity) {
  world.velocity_of_b = velocity;
  return world;
}

inline double noise_db(const acoustics::NoiseSources& sources, double low_hz = 22'500,
                       double high_hz = 27'500) {
  return acoustics::noise_level_over_band(low_hz, high_hz, sources).value;
}
// Of the whole straight link, dB.
inline double absorbed_db(const acoustics::Environment& water, double depth_m = 50, double khz = 25) {
  return kRangeM / 1000 * absorption_spectrum_at(water, depth_m).db_per_km(khz * khz);
}
// As loud as makes up for what the water absorbs, so that it starts from the same ratio of signal to noise.
inline World in_water(World world, const acoustics::Environment& water) {
  world.modem.modem.source_level.value += absorbed_db(water) - absorbed_db(world.water);
  world.water = water;
  return world;
}
// Between ends of one depth.
inline double delay_s(const acoustics::Environment& water, double depth_m = 50) {
  return kRangeM / water.profile.sound_speed_mps(depth_m);
}

// What follows from a better or worse ratio of signal to noise.
inline Moves clearer() { return {rises("capacity"), rises("acquisition"), rises("success")}; }
inline Moves dimmer() { return {falls("capacity"), falls("acquisition"), falls("success")}; }
inline Moves not_acquired() { return dimmer() + Moves{becomes("outcome", packet_outcome_t::NOT_ACQUIRED)}; }
// One straight path: every level in step.
inline Moves ratio_by(double db) { return {moves_by("snr", db), moves_by("sinr", db)}; }
inline Moves loss_by(double db) {
  return Moves{moves_by("loss", db), moves_by("level", -db)} + ratio_by(-db);
}
inline Moves delay_by(double seconds) {  // a packet's instants are whole nanoseconds
  return {moves_by("link delay", seconds), moves_by("packet delay", seconds, 3e-9)};
}
inline Moves undecided() { return {becomes("sinr", 0), becomes("acquisition", 0), becomes("success", 0)}; }

inline const double kWindyDb = noise_db({0.5, 10}) - noise_db({0.5, 0}),
                    kBusyDb = noise_db({1, 0}) - noise_db({0.5, 0});
inline constexpr double kDoubleDb = 6, kMoving = 2;  // dB; m/s

}  // namespace halocline::channel_server::testing
