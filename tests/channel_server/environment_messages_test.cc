// SPDX-License-Identifier: BSD-3-Clause
// The message of the environment, from the models to the bus.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/noise/noise_spectrum.h"
#include "acoustics/noise/place_noise.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "bus/messages/message_checks.h"
#include "channel_server/messages/world_messages.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

TEST(EnvironmentMessages, TheEnvironmentExplainsItself) {
  const acoustics::Environment water;
  const environment_t message = to_message(water, {"straight", {}, {}}, at_s(60), "terrain-7");
  EXPECT_EQ(bus::problem_in(message), "");
  EXPECT_EQ(message.num_layers, 15);
  EXPECT_EQ(message.layer_temperature_degc.at(1), 15.09);
  EXPECT_EQ(message.sound_speed_model, "mackenzie");
  EXPECT_EQ(message.absorption_model, "fisher-simmons");
  EXPECT_EQ(message.terrain_version, "terrain-7");
}

TEST(EnvironmentMessages, TheNoiseOfThePlaceIsNamed) {
  const auto place_in = [](const acoustics::Environment& water) {
    return to_message(water, {"straight", {}, {}}, at_s(0), "").noise_place;
  };
  acoustics::Environment water;
  EXPECT_EQ(place_in(water), "open");
  water.noise.place = acoustics::NoisePlace::kReefEdge;
  EXPECT_EQ(place_in(water), "reef-edge");
  water.noise.site =
      std::make_shared<const acoustics::NoiseSpectrum>(std::vector<double>{1e3}, std::vector<double>{60});
  EXPECT_EQ(place_in(water), "measured");
}

TEST(EnvironmentMessages, AProfileThatIsAFormulaIsTabulated) {
  acoustics::Environment water;
  water.profile = acoustics::SoundSpeedProfile::munk({10, 35});
  const environment_t message = to_message(water, {"straight", {}, {}}, at_s(0), "");
  EXPECT_EQ(bus::problem_in(message), "");
  EXPECT_EQ(message.num_layers, 51);
}

TEST(EnvironmentMessages, ALongProfileIsThinnedToWhatAMessageHolds) {
  std::vector<acoustics::SpeedRow> rows;
  for (int i = 0; i < 5000; ++i) rows.push_back({1.0 * i, 1500});
  acoustics::Environment water;
  water.profile = acoustics::SoundSpeedProfile::from_speeds(rows, {10, 35});
  EXPECT_EQ(bus::problem_in(to_message(water, {"straight", {}, {}}, at_s(0), "")), "");
}

}  // namespace
}  // namespace halocline::channel_server
