// SPDX-License-Identifier: BSD-3-Clause
// Predicted against realised at places drawn at random: both ends at rest, in water of several depths, under
// winds of 0 to 10 m/s, with noise that puts most links on the flank of their curve. The mean of the
// predictions is that of the packets' probabilities within 2 % and what chance may add to so many places with
// 99 % confidence.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "acoustics/prediction/link_prediction.h"
#include "acoustics/reception/reception_curves.h"
#include "bus/config/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/channel_server/sea/still_link.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

constexpr std::size_t kPayloadBytes = 32;
constexpr std::uint64_t kPlaces = 60;
constexpr int kPackets = 40;  // of a place
constexpr double kWithin = 0.02, kConfidence = 2.6;

struct Sea {
  const char* profile;
  double depth_m;
};

class RandomPlaces : public ::testing::TestWithParam<Sea> {};

double draw(std::uint64_t place, std::uint32_t what, double low, double high) {
  return low + (high - low) * uniform_at({.seed = 31, .who = what, .which = place});
}

Reception reception_at(std::uint64_t place, double depth_m, const acoustics::Modem& modem,
                       const RayModel& model) {
  ChannelServerConfig config;
  config.environment.noise.wind_mps = draw(place, 0, 0, 10);
  const auto depth = [&](std::uint32_t end) { return draw(place, end, 0.02, 0.97) * depth_m; };
  const Vec3 from(0, 0, depth(1)), to(std::pow(10, draw(place, 3, 2, 3.5)), 0, depth(2));
  RayPropagation propagation(
      std::make_shared<EnvironmentTimeline>(make_environment(config.environment, bus::Scenario())),
      testing::seabed_around(from, to, [&](double) { return depth_m; }), model);
  return propagation.reception(at_s(1), {1, from, Vec3::Zero(), &modem}, {2, to, Vec3::Zero(), &modem});
}

TEST_P(RandomPlaces, DeliverAsManyPacketsAsPredicted) {
  const acoustics::Modem modem = load_modem(GetParam().profile).modem;
  const std::size_t payload = std::min(kPayloadBytes, max_payload_bytes(modem));
  const acoustics::ReceptionCurves curves(modem, payload);
  const RayModel model = make_rays(ChannelServerConfig());
  double difference = 0, squares = 0, delivered = 0, places = 0;
  for (std::uint64_t i = 0; i < kPlaces; ++i) {
    const Reception reception = reception_at(i, GetParam().depth_m, modem, model);
    if (reception.paths.empty()) continue;
    const Decibels noise = total_level(reception.paths) - Decibels{draw(i, 4, -5, 25)};
    double mean = 0, predicted = 0;
    for (int k = 0; k < kPackets; ++k) {
      // Of a link each, so that they are independent.
      const testing::StillLink link(reception, modem, payload, model.fading,
                                    static_cast<std::uint32_t>(i * kPackets) + static_cast<std::uint32_t>(k),
                                    noise);
      mean += link.delivery(100) / kPackets;
      if (k == 0) predicted = link.prediction(curves).delivery_probability;
    }
    places += 1;
    delivered += mean;
    difference += predicted - mean;
    squares += (predicted - mean) * (predicted - mean);
  }
  ASSERT_GT(places, kPlaces / 2);
  difference /= places;
  const double deviation = std::sqrt(std::max(squares / places - difference * difference, 0.0) / places);
  EXPECT_NEAR(difference, 0, kWithin + kConfidence * deviation);
  EXPECT_LT(deviation, kWithin);  // else the check says nothing
  EXPECT_GT(delivered, 0);
}

INSTANTIATE_TEST_SUITE_P(Seas, RandomPlaces,
                         ::testing::Values(Sea{"micromodem-psk-1", 20}, Sea{"micromodem-psk-1", 100},
                                           Sea{"micromodem-psk-1", 1000}, Sea{"micromodem-psk-5", 20},
                                           Sea{"micromodem-psk-5", 100}, Sea{"micromodem-psk-5", 1000},
                                           Sea{"micromodem-fsk", 100}),
                         [](const auto& parameter) {
                           std::string name =
                               fmt::format("{}_{}_m", parameter.param.profile, parameter.param.depth_m);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace halocline::channel_server
