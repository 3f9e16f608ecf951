// SPDX-License-Identifier: BSD-3-Clause
// The plainest coastal case: 171 links of frequency-hopped FSK in a summer column, 22 degC to 15 m, 15 degC
// at 30 m and 13 degC at 50 m, over 100 m of medium sand. All have the noise that makes the
// median of their SNR what a row says.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "core/frames.h"
#include "core/random.h"
#include "tests/channel_server/sea/still_link.h"
#include "tests/support/doc_table.h"

namespace halocline::channel_server {
namespace {

using testing::StillLink;

constexpr double kDepthM = 100;
constexpr int kNodes = 19;
constexpr std::size_t kPayloadBytes = 32;

acoustics::Environment column(double wind_mps) {
  acoustics::Environment environment;
  environment.profile = acoustics::SoundSpeedProfile::from_water(
      {{0, 22, 38}, {15, 22, 38}, {30, 15, 38}, {50, 13, 38}, {100, 13, 38}},
      acoustics::SoundSpeedModel::kMackenzie1981, 0);
  environment.noise.wind_mps = wind_mps;
  return environment;
}

// Nodes in a box of 3 km, 3 to 97 m deep.
std::vector<Vec3> nodes() {
  std::vector<Vec3> places;
  for (std::uint64_t i = 0; i < kNodes; ++i) {
    const auto u = [&](std::uint32_t who) { return uniform_at({.seed = 11, .who = who, .which = i}); };
    places.push_back({3000 * u(0), 3000 * u(1), 3 + 94 * u(2)});
  }
  return places;
}

struct Column {
  double received = 0;   // share of packets
  double predicted = 0;  // the same, by the links' predictions
  int perfect = 0, dead = 0, links = 0;
};

// Of each link so many packets, 10 minutes apart.
Column deliver(const acoustics::Modem& modem, double wind_mps, double snr_db, int packets) {
  RayModel model;
  model.bottom = *acoustics::sediment("MediumSand");
  model.options.max_bounces = 60;
  model.options.keep_steep_direct = true;
  model.options.min_boundary_factor = std::pow(10, -1.5);
  model.fading.enabled = true;
  RayPropagation propagation(std::make_shared<EnvironmentTimeline>(column(wind_mps)),
                             std::make_shared<SeabedMap>(SeabedRule{}), model);
  const auto seabed = std::make_shared<const SeabedProfile>(SeabedProfile::flat(kDepthM));
  const acoustics::ReceptionCurves curves(modem, kPayloadBytes);
  std::vector<Reception> receptions;
  std::vector<double> levels;
  const std::vector<Vec3> places = nodes();
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      receptions.push_back(propagation.reception_over(SimTime(), {0, places[i], Vec3::Zero(), &modem},
                                                      {0, places[j], Vec3::Zero(), &modem}, seabed));
      levels.push_back(receptions.back().budget.received_level.value);
    }
  }
  std::nth_element(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2),
                   levels.end());
  const Decibels noise{levels[levels.size() / 2] - snr_db};
  Column column;
  std::uint32_t pair = 0;
  for (const Reception& reception : receptions) {
    const StillLink link(reception, modem, kPayloadBytes, model.fading, ++pair, noise);
    int received = 0;
    for (int n = 0; n < packets; ++n) received += link.delivers(600.0 * n);
    column.received += static_cast<double>(received) / packets;
    column.predicted += link.prediction(curves).delivery_probability;
    column.perfect += received == packets;
    column.dead += received == 0;
    ++column.links;
  }
  column.received /= column.links;
  column.predicted /= column.links;
  return column;
}

TEST(SummerColumn, DeliversFrequencyHoppedPacketsAtEveryWindAndNeverBetterForIt) {
  const acoustics::Modem modem = load_modem("micromodem-fsk").modem;
  double calm = 0;
  for (const double wind_mps : {0.0, 2.0, 5.0, 10.0}) {
    double last = 0;
    for (const double snr_db : {15.0, 25.0, 35.0, 45.0, 55.0}) {
      const int packets = snr_db == 45 ? 100 : 6;
      const Column column = deliver(modem, wind_mps, snr_db, packets);
      halocline::testing::doc_row(
          "summer", {fmt::format("{:g}", wind_mps), fmt::format("{:g}", snr_db), fmt::format("{}", packets),
                     fmt::format("{:.3f}", column.received), fmt::format("{:.3f}", column.predicted),
                     fmt::format("{}", column.links - column.perfect), fmt::format("{}", column.dead)});
      // 171 links: what fades by itself is the link, so 3.3 deviations are 3.3 sqrt(1/4 / 171) at most.
      EXPECT_NEAR(column.received, column.predicted, 0.05);
      EXPECT_GE(column.predicted, last - 1e-3) << "more source level delivers less";
      last = column.predicted;
      // Above 15 dB wind makes paths fade faster than a packet lasts, and its code takes the mean: nothing is
      // lost. In calm water the nulls of the band stand still.
      if (snr_db == 15 || (snr_db == 45 && wind_mps == 0)) {
        EXPECT_LT(column.perfect, column.links) << "some links lose some packets";
      }
      if (snr_db != 45) continue;
      EXPECT_GT(column.received, 0.5);
      if (wind_mps == 0) calm = column.predicted;
      EXPECT_LT(column.predicted - calm, 0.15) << "wind helps";
    }
  }
}

}  // namespace
}  // namespace halocline::channel_server
