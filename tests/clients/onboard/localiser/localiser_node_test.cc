// SPDX-License-Identifier: BSD-3-Clause
// The localiser against a sea of one's own: beacons that answer pings with the times of still water.
#include "clients/onboard/localiser/localiser_node.h"

#include <cmath>

#include <gtest/gtest.h>

#include "bus/runtime/lockstep_runner.h"
#include "bus/transport/event_log.h"
#include "channel_server/packets/packet.h"
#include "core/check.h"
#include "core/frames.h"
#include "tests/bus/runtime/journal_files.h"

namespace halocline::clients {
namespace {

using bus::channels::kEnvironment;

constexpr double kSoundSpeedMps = 1500, kSurfaceZ = -2, kPingDurationS = 0.25;

LocaliserConfig two_beacons() {
  LocaliserConfig config;
  config.vehicles.resize(3);
  config.vehicles[0].vehicle = "auv";
  config.vehicles[0].vehicle_id = 1;
  config.vehicles[0].beacons = "left right";
  config.vehicles[0].ping_period = SimDuration::from_milliseconds(4000);
  config.vehicles[1] = {.vehicle = "left", .vehicle_id = 2, .start_ned_m = {0, 0, 40}};
  config.vehicles[2] = {.vehicle = "right", .vehicle_id = 3, .start_ned_m = {0, 800, 40}};
  return config;
}

// Moves the vehicle and answers its pings; all positions are known to it.
class Sea : public bus::Node {
 public:
  Sea(lcm::LCM& lcm, const LocaliserConfig& config) : Node(lcm, {"sea", 9}), config_(config) {
    bus().subscribe<modem_send_t>(bus::channels::kSend.of("auv"),
                                  [this](const modem_send_t& ping) { answer(ping); });
    bus().subscribe<position_estimate_t>(bus::channels::kEstimate.of("auv"),
                                         [this](const position_estimate_t& e) { estimates.push_back(e); });
  }

  std::vector<position_estimate_t> estimates;
  std::vector<modem_send_t> pings;
  bool publishes_water = true, publishes_state = true;

  static Vec3 place(SimTime at) { return {300 + 1.5 * at.seconds(), 200, 50 + kSurfaceZ}; }

 protected:
  bus::Due on_due() const override { return {.sim = next_}; }
  void on_step(const bus::Now& now) override {
    if (now.sim < next_) return;
    if (now.sim == SimTime() && publishes_water) publish_water();
    vehicle_sensors_t sensors{};
    sensors.utime = now.sim.to_utime();
    sensors.depth_m = 50;
    sensors.water_speed_mps = 1.5;
    bus().publish(bus::channels::kSensors.of("auv"), sensors);
    vehicle_state_t state{};
    state.utime = now.sim.to_utime();
    state.vehicle_id = 1;
    state.orientation_wxyz[0] = 1;
    Eigen::Map<Vec3>(state.position_ned_m) = place(now.sim);
    state.velocity_ned_mps[0] = 1.5;
    if (publishes_state) bus().publish(bus::channels::kState.of("auv"), state);
    next_ = now.sim + SimDuration::from_milliseconds(500);
  }
  std::string status_text() const override { return ""; }

 private:
  void publish_water() {
    environment_t water{};
    water.num_layers = 1;
    water.layer_depth_m = {0};
    water.layer_sound_speed_mps = {kSoundSpeedMps};
    water.layer_temperature_degc = {10};
    water.layer_salinity_psu = {35};
    water.acidity_ph = 8;
    water.sea_surface_z_m = kSurfaceZ;
    water.spreading_exponent = 1.5;
    bus().publish(kEnvironment, water);
  }
  void answer(const modem_send_t& ping) {
    pings.push_back(ping);
    const auto& beacon = config_.vehicles.at(static_cast<std::size_t>(ping.destination_id - 1));
    const SimTime left = SimTime::from_utime(ping.utime);
    modem_receipt_t receipt{};
    receipt.send_session = ping.session;
    receipt.packet_sequence = ping.packet_sequence;
    receipt.start_utime = ping.utime;
    receipt.duration_s = kPingDurationS;
    bus().publish(bus::channels::kReceipt.of("auv"), receipt);
    const double out_s = (place(left) - beacon.start_ned_m).norm() / kSoundSpeedMps;
    const SimTime answer_leaves =
        left + SimDuration::from_seconds(out_s + kPingDurationS) + channel_server::kReplyTurnaround;
    // Where the vehicle is when the answer comes: a fixed point, of which three steps leave micrometres.
    double back_s = out_s;
    for (int i = 0; i < 3; ++i)
      back_s = (place(answer_leaves + SimDuration::from_seconds(back_s)) - beacon.start_ned_m).norm() /
               kSoundSpeedMps;
    modem_receive_t reply{};
    reply.utime = (answer_leaves + SimDuration::from_seconds(back_s + kPingDurationS)).to_utime();
    reply.send_session = ping.session;
    reply.packet_sequence = ping.packet_sequence;
    reply.source_id = ping.destination_id;
    reply.destination_id = reply.receiver_id = 1;
    reply.packet_kind = modem_receive_t::PING_REPLY;
    reply.two_way_travel_time_s = out_s + back_s;
    reply.strongest_path_doppler_factor = 1;
    bus().publish(bus::channels::kReceive.of("auv"), reply);
  }

  LocaliserConfig config_;
  SimTime next_;
};

class LocaliserNodeTest : public ::testing::Test {
 protected:
  LocaliserNodeTest() { bus::set_log_level(bus::LogLevel::kSilent); }

  void run(const LocaliserConfig& config, double seconds) {
    LocaliserNode node(lcm_, {"localiser", 5}, config);
    bus::LockstepRunner runner({&sea_, &node});
    runner.run_until(SimTime::from_seconds(seconds));
  }

  lcm::LCM lcm_{"memq://"};
  Sea sea_{lcm_, two_beacons()};
};

TEST_F(LocaliserNodeTest, PingsOneBeaconAfterTheOtherOnItsGrid) {
  run(two_beacons(), 13);
  ASSERT_EQ(sea_.pings.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(sea_.pings[i].packet_kind, modem_send_t::PING);
    EXPECT_EQ(sea_.pings[i].destination_id, i % 2 == 0 ? 2 : 3);
    EXPECT_EQ(sea_.pings[i].utime, static_cast<std::int64_t>(i) * 4'000'000);
  }
}

// Even water, no faults, and the vehicle under way while sound travels: nothing is left but rounding of times
// to microseconds (1.5 mm) and of the linearisation.
TEST_F(LocaliserNodeTest, FindsTheVehicleToAMillimetreScaleWhereNothingErrs) {
  run(two_beacons(), 120);
  const position_estimate_t& last = sea_.estimates.back();
  EXPECT_EQ(last.estimate_status, position_estimate_t::UNIQUE);
  EXPECT_LT(std::hypot(last.error_ned_m[0], last.error_ned_m[1]), 0.02);
  EXPECT_NEAR(last.error_ned_m[2], 0, 1e-9);
  EXPECT_NEAR(last.position_ned_m[2], 50 + kSurfaceZ, 1e-9);
}

TEST_F(LocaliserNodeTest, PublishesNoPositionBeforeRangesToBothBeacons) {
  run(two_beacons(), 4);
  EXPECT_EQ(sea_.estimates.back().estimate_status, position_estimate_t::NONE);
  EXPECT_EQ(sea_.estimates.back().likelihood, 0);
}

TEST_F(LocaliserNodeTest, UsesNoRangeBeforeTheFirstEnvironment) {
  sea_.publishes_water = false;
  run(two_beacons(), 60);
  EXPECT_EQ(sea_.estimates.back().estimate_status, position_estimate_t::NONE);
  EXPECT_EQ(sea_.estimates.back().ranges_used, 0);
}

TEST_F(LocaliserNodeTest, FindsItsPlaceWithoutTheTruth) {
  sea_.publishes_state = false;
  run(two_beacons(), 120);
  const position_estimate_t& last = sea_.estimates.back();
  EXPECT_FALSE(last.truth_known);
  EXPECT_EQ(last.error_ned_m[0], 0);
  const Vec3 truth = Sea::place(SimTime::from_utime(last.utime));
  EXPECT_LT((Vec3(last.position_ned_m) - truth).norm(), 0.02);
}

TEST_F(LocaliserNodeTest, NumbersItsEstimates) {
  run(two_beacons(), 3);
  ASSERT_GE(sea_.estimates.size(), 3u);
  for (std::size_t i = 0; i < sea_.estimates.size(); ++i)
    EXPECT_EQ(sea_.estimates[i].sequence, static_cast<std::int64_t>(i));
}

TEST(LocaliserConfig, RefusesABeaconThatIsNoOtherVehicle) {
  LocaliserConfig config = two_beacons();
  config.vehicles[0].beacons = "left nowhere";
  EXPECT_THROW(beacons_of(config, config.vehicles[0]), InvalidArgument);
  config.vehicles[0].beacons = "left auv";
  EXPECT_THROW(beacons_of(config, config.vehicles[0]), InvalidArgument);
}

TEST_F(LocaliserNodeTest, KilledItGoesOnWithItsEstimateAndItsNumbers) {
  const bus::testing::JournalFiles files;
  LocaliserNode whole(lcm_, {"localiser", 5}, two_beacons());
  whole.keep_state_in(files.open());
  bus::LockstepRunner({&sea_, &whole}).run_until(SimTime::from_seconds(30));
  LocaliserNode resumed(lcm_, {"localiser", 5}, two_beacons());
  resumed.keep_state_in(files.open());
  sea_.estimates.clear();
  whole.step({SimTime::from_seconds(31), SimTime::from_seconds(31)});
  resumed.step({SimTime::from_seconds(31), SimTime()});
  while (lcm_.handleTimeout(0) > 0) {
  }
  ASSERT_EQ(sea_.estimates.size(), 2u);
  EXPECT_EQ(sea_.estimates[0].estimate_status, position_estimate_t::UNIQUE);
  EXPECT_EQ(sea_.estimates[1].estimate_status, position_estimate_t::UNIQUE);
  EXPECT_EQ(sea_.estimates[1].sequence, sea_.estimates[0].sequence);
  EXPECT_EQ(sea_.estimates[1].ranges_used, sea_.estimates[0].ranges_used);
  // One of them has the last measurement of a steady motion more.
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(sea_.estimates[1].position_ned_m[axis], sea_.estimates[0].position_ned_m[axis], 1e-6);
}

}  // namespace
}  // namespace halocline::clients
