// A weak link and a packet over it in a small world, all numbers that the channel server tells of them, and
// claims about how each moves: for tests that turn one input alone.
//
// The link is 800 m long, at a depth of 50 m over 200 m of water, and so weak that the packet is noticed and right
// with probabilities well inside 0..1: they show what moves them.
#pragma once

#include <cmath>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "bus/event_log.h"
#include "tests/channel_server/node_bench.h"

namespace halocline::channel_server::testing {

inline constexpr double kAt = 3;  // s: table and packet
inline constexpr double kRangeM = 800;
inline constexpr std::int32_t kBytes = 10;
// Of packets with this number the draws are 0.41 (noticed) and 0.56 (right), so that fates move with the
// probabilities.
inline constexpr std::int64_t kSequence = 5;

// Before the first late echo comes a packet along rays has the noise alone against it.
constexpr double preamble_s(bool rays) { return rays ? 0.0008 : 0.0033; }

constexpr double bit_rate_bps(bool rays) { return rays ? 500 : 640; }

inline VehicleModem weak_modem(bool rays) {
  VehicleModem modem = quick_modem();
  modem.modem.source_level = {rays ? 125.0 : 106.8};
  modem.modem.min_receivable_level = {0};
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
          {"link delay", row.delay_s},
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
          {"fate", packet.outcome}};
}

inline Numbers numbers_of(const World& world) {
  bus::set_log_level(bus::LogLevel::kSilent);
  NodeBench bench({}, {world.modem, {}},
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

}  // namespace halocline::channel_server::testing
