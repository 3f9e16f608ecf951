// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/replay_config.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/water_model.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/support/channel_file.h"

namespace halocline::channel_server {
namespace {

using ::testing::HasSubstr;

class ReplayConfigTest : public ::testing::Test {
 protected:
  ReplayConfigTest() {
    auto file = halocline::testing::channel_file(10, 2, 1);
    for (std::size_t i = 0; i < 10; ++i) {
      file.at(i, 0, 0) = 0.001;
      file.at(i, 1, 0) = 0.01;
    }
    halocline::testing::write_channel_file(file, "replayed.mat");
    for (const int id : {1, 2, 3}) scenario.vehicles.push_back({.name = "v" + std::to_string(id), .id = id});
  }
  // [propagation] holds `keys`; straight paths.
  WaterModel water_of(const std::string& keys, const std::string& other = "") {
    auto file = bus::ConfigFile::parse("[propagation]\nmodel = \"straight\"\n" + keys + "\n" + other,
                                       halocline::testing::channel_file_folder() + "/test.toml");
    ChannelServerConfig config;
    file.read([&](bus::ConfigVisitor& v) { visit(v, config); });
    file.check(/*whole_file=*/false);
    return make_water_model(config, scenario);
  }
  std::string refusal_of(const std::string& keys, const std::string& other = "") {
    try {
      water_of(keys, other);
    } catch (const InvalidArgument& error) {
      return error.what();
    }
    return "";
  }
  // Gain of the record that a link is replayed from, dB; 0 of none.
  static double gain_db(const WaterModel& water, VehicleId from, VehicleId to) {
    const acoustics::Modem modem;
    const Reception reception = water.propagation->reception(
        SimTime(), {from, {0, 0, 10}, Vec3::Zero(), &modem}, {to, {500, 0, 10}, Vec3::Zero(), &modem});
    return reception.measured ? to_decibels(PowerRatio{reception.measured->power()}).value : 0;
  }

  bus::Scenario scenario;
};

TEST_F(ReplayConfigTest, AFileIsReplayedOnEveryLink) {
  const WaterModel water = water_of("replay = \"replayed.mat\"");
  EXPECT_NEAR(gain_db(water, 1, 2), -60, 1e-4);
  EXPECT_NEAR(gain_db(water, 3, 2), -60, 1e-4);
  EXPECT_NEAR(gain_db(water_of("replay = \"replayed.mat\"\nreplay_receiver = 1"), 1, 2), -40, 1e-4);
  EXPECT_EQ(gain_db(water_of(""), 1, 2), 0);
}

TEST_F(ReplayConfigTest, TheLevelIsTheModelsOrTheFiles) {
  const acoustics::Modem modem;
  const auto level = [&](const std::string& keys) {
    return water_of("replay = \"replayed.mat\"\n" + keys)
        .propagation
        ->reception(SimTime(), {1, {0, 0, 10}, Vec3::Zero(), &modem}, {2, {500, 0, 10}, Vec3::Zero(), &modem})
        .budget.received_level.value;
  };
  EXPECT_NEAR(level("replay_level = \"file\""), modem.source_level.value - 60, 1e-4);
  EXPECT_EQ(level(""), level("replay_level = \"rays\""));
  EXPECT_GT(level(""), modem.source_level.value - 55);  // 1.5 * 10 log 500 and absorption
}

TEST_F(ReplayConfigTest, APairHasItsOwnFileAndReceiver) {
  const WaterModel water = water_of(
      "[[propagation.replay_pair]]\nfrom = \"v1\"\nto = \"v3\"\nfile = \"replayed.mat\"\nreceiver = 1");
  EXPECT_NEAR(gain_db(water, 1, 3), -40, 1e-4);
  EXPECT_NEAR(gain_db(water, 3, 1), -40, 1e-4);
  EXPECT_EQ(gain_db(water, 1, 2), 0);
}

TEST_F(ReplayConfigTest, WhatCannotBeIsRefusedWithItsPlace) {
  EXPECT_THAT(refusal_of("replay = \"no-such.mat\""), HasSubstr("no-such.mat: there is no such file"));
  EXPECT_THAT(refusal_of("replay = \"replayed.mat\"\nreplay_receiver = 2"), HasSubstr("has 2 receivers"));
  EXPECT_THAT(refusal_of("replay = \"replayed.mat\"", "[modem]\ncenter_frequency_hz = 26000"),
              HasSubstr("was measured from 22500 to 27500 Hz; the modem of v1 has 23500 to 28500 Hz"));
  const std::string pair = "[[propagation.replay_pair]]\nfrom = \"v1\"\n";
  EXPECT_THAT(refusal_of(pair + "to = \"v9\"\nfile = \"replayed.mat\""), HasSubstr("'v9'"));
  EXPECT_THAT(refusal_of(pair + "to = \"v1\"\nfile = \"replayed.mat\""),
              HasSubstr("another vehicle than from"));
  EXPECT_THAT(refusal_of(pair + "to = \"v2\""), HasSubstr("file"));
  const std::string whole = pair + "to = \"v2\"\nfile = \"replayed.mat\"\n";
  EXPECT_THAT(refusal_of(whole + whole), HasSubstr("v1 to v2 has two entries"));
}

}  // namespace
}  // namespace halocline::channel_server
