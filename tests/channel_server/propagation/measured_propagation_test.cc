// SPDX-License-Identifier: BSD-3-Clause
// Measured channels in the place of modelled paths, and what becomes of packets over them.
#include "channel_server/propagation/measured_propagation.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/measured_fading.h"
#include "acoustics/link/link_budget.h"
#include "tests/channel_server/scripted_water.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::path;
using testing::ScriptedPropagation;

constexpr double kRateHz = 10;
constexpr std::size_t kInstants = 200;  // 20 s

// Half of the record is 80 dB below the other; the second tap 6 dB below the first.
MeasuredLinks::Record deep_fade(float gain = 1) {
  acoustics::ChannelRecord record{"fade.mat", 25'000, 5000, kRateHz, 3, {}};
  for (std::size_t i = 0; i < kInstants; ++i) {
    const float g = i < kInstants / 2 ? gain : gain * 1e-4F;
    record.taps.insert(record.taps.end(), {{g, 0}, {0, 0}, {0, g / 2}});
  }
  return std::make_shared<const acoustics::ChannelRecord>(record);
}

class MeasuredWater : public testing::ScriptedWater {
 protected:
  MeasuredPropagation& measure(MeasuredLinks links) {
    auto model = std::make_unique<ScriptedPropagation>();
    for (const auto& [from, to] : {std::pair(1, 2), std::pair(2, 1), std::pair(1, 3)}) {
      model->set(from, to, {path(1, 100), path(1.5, 104, 1.0001), path(1.6, 90)});
    }
    measured = std::make_unique<MeasuredPropagation>(
        std::move(model), std::make_shared<EnvironmentTimeline>(testing::even_water()), std::move(links));
    return *measured;
  }
  LinkEnd end(VehicleId id) const { return {id, {1000.0 * id, 0, 50}, Vec3::Zero(), &modem}; }
  Reception reception(VehicleId from, VehicleId to) {
    return measured->reception(at_s(1), end(from), end(to));
  }

  acoustics::Modem modem = big_modem().modem;
  std::unique_ptr<MeasuredPropagation> measured;
};

TEST_F(MeasuredWater, TracksAreTheStrongestTapsByDelay) {
  constexpr std::size_t kTaps = 80;
  acoustics::ChannelRecord record{"long.mat", 25'000, 5000, kRateHz, kTaps, {}};
  for (std::size_t i = 0; i < kInstants; ++i) {
    for (std::size_t tap = 0; tap < kTaps; ++tap)
      record.taps.push_back({tap < 40 ? 0.01F : 0.02F, 0});  // the later half is the stronger
  }
  measure({.all = std::make_shared<const acoustics::ChannelRecord>(record)});
  const Reception replayed = reception(1, 2);
  ASSERT_EQ(replayed.paths.size(), kTaps);
  const LinkChart chart = measured->chart(at_s(1), end(1), end(2));
  ASSERT_EQ(chart.rows.size(), LinkChart::kMaxPaths);
  EXPECT_EQ(chart.paths_left_out, kTaps - LinkChart::kMaxPaths);
  EXPECT_EQ(chart.rows.back().arrival.delay_s, replayed.paths.back().delay_s);
  for (std::size_t i = 1; i < chart.rows.size(); ++i)
    EXPECT_LT(chart.rows[i - 1].arrival.delay_s, chart.rows[i].arrival.delay_s);
}

TEST_F(MeasuredWater, TapsReplaceThePathsFromTheFirstSignificantOnAtTheModelsLevel) {
  measure({.all = deep_fade()});
  const Reception replayed = reception(1, 2);
  ASSERT_TRUE(replayed.measured);
  ASSERT_EQ(replayed.paths.size(), 2u);
  EXPECT_EQ(replayed.paths[0].delay_s, 1);
  EXPECT_NEAR(replayed.paths[1].delay_s, 1 + 2 / 5000.0, 1e-12);
  EXPECT_EQ(replayed.paths[1].doppler_factor, 1);
  EXPECT_NEAR((replayed.paths[0].level - replayed.paths[1].level).value, 20 * std::log10(2.0), 1e-4);
  EXPECT_NEAR(total_level(replayed.paths).value, replayed.budget.received_level.value, 1e-9);
  EXPECT_NEAR(replayed.budget.received_level.value,
              total_level({path(1, 100), path(1, 104), path(1, 90)}).value, 1e-9);
  EXPECT_NEAR(replayed.delay_spread_s, 2 / 5000.0, 1e-12);
}

TEST_F(MeasuredWater, TheLevelOfTheRecordIsItsGainOverTheSourceLevel) {
  measure({.all = deep_fade(1e-4F), .level_of_record = true});
  const Reception replayed = reception(1, 2);
  const double gain_db = 10 * std::log10(replayed.measured->power());
  EXPECT_NEAR(gain_db, -80 + 10 * std::log10(1.25 / 2), 0.05);  // values on the flanks are a little less
  const acoustics::LinkBudget& budget = replayed.budget;
  EXPECT_NEAR(budget.received_level.value, modem.source_level.value + gain_db, 1e-9);
  EXPECT_NEAR(budget.transmission_loss.value, -gain_db, 1e-9);
  EXPECT_NEAR(total_level(replayed.paths).value, budget.received_level.value, 1e-9);
  EXPECT_EQ(budget.delay_s, 1);
}

TEST_F(MeasuredWater, APairsRecordIsThatOfTheWayBackTooAndOthersAreModelled) {
  measure({.pairs = {{{1, 2}, deep_fade()}}});
  EXPECT_TRUE(reception(1, 2).measured);
  EXPECT_TRUE(reception(2, 1).measured);
  EXPECT_FALSE(reception(1, 3).measured);
  EXPECT_EQ(reception(1, 3).paths.size(), 3u);
}

TEST_F(MeasuredWater, APairsOwnRecordCountsBeforeThatOfAllAndOfTheOtherWay) {
  const auto all = deep_fade(), there = deep_fade(2), back = deep_fade(3);
  const MeasuredLinks links{.all = all, .pairs = {{{1, 2}, there}, {{2, 1}, back}}};
  EXPECT_EQ(links.of(1, 2), there);
  EXPECT_EQ(links.of(2, 1), back);
  EXPECT_EQ(links.of(1, 3), all);
  EXPECT_EQ(links.of(0, 3), nullptr);
}

TEST_F(MeasuredWater, WithoutAPathOrOutsideTheMeasuredBandALinkStaysAsModelled) {
  measure({.all = deep_fade()});
  EXPECT_EQ(reception(3, 4).state, PathState::kShadow);
  EXPECT_FALSE(reception(3, 4).measured);
  modem.centre_frequency_hz += 10;
  EXPECT_FALSE(reception(1, 2).measured);
}

// 64 bytes take 0.64 s; packets within the record's loud half are received, those within its quiet half lost.
TEST_F(MeasuredWater, ADeepFadeOfTheRecordLosesThePacketsInIt) {
  MeasuredPropagation& replay = measure({.all = deep_fade()});
  const std::uint64_t seed = 42;
  PacketMedium judge(
      fleet, replay,
      {.max_lateness = testing::for_s(10), .max_earliness = testing::for_s(200), .seed = seed});
  const int packets = 90;
  for (int n = 0; n < packets; ++n) {
    EXPECT_FALSE(judge.transmit(testing::request_of(1, 1 + n, n, 64), SimTime()));
  }
  const double offset_s =
      acoustics::MeasuredFading(reception(1, 2).measured, {.seed = seed, .lower_id = 1, .higher_id = 2})
          .offset_s();
  int received = 0, lost = 0;
  for (const PacketOutcome& outcome : testing::outcomes_in(judge.advance_to(at_s(110)))) {
    if (outcome.receiver_id != 2) continue;
    const double begin_s = outcome.packet->departure.seconds() + 1 + offset_s;
    const double place = std::fmod(begin_s, 20), end = place + 0.64;
    if (place > 0.2 && end < 9.7) {
      EXPECT_EQ(outcome.kind, OutcomeKind::kReceived) << place;
      ++received;
    } else if (place > 10.1 && end < 19.7) {
      EXPECT_EQ(outcome.kind, OutcomeKind::kBitErrors) << place;
      EXPECT_LT(outcome.statistics.sinr.value, -20);
      ++lost;
    }
  }
  EXPECT_GE(received, 30);
  EXPECT_GE(lost, 30);
}

TEST_F(MeasuredWater, TheSameSeedGivesTheSameOutcomesAndAnotherOthers) {
  MeasuredPropagation& replay = measure({.all = deep_fade()});
  const auto kinds = [&](std::uint64_t seed) {
    PacketMedium judge(
        fleet, replay,
        {.max_lateness = testing::for_s(10), .max_earliness = testing::for_s(200), .seed = seed});
    for (int n = 0; n < 40; ++n) {
      EXPECT_FALSE(judge.transmit(testing::request_of(1, 1 + n, n, 16), SimTime()));
    }
    std::vector<OutcomeKind> all;
    for (const auto& outcome : testing::outcomes_in(judge.advance_to(at_s(110)))) all.push_back(outcome.kind);
    return all;
  };
  EXPECT_EQ(kinds(1), kinds(1));
  EXPECT_NE(kinds(1), kinds(2));
}

}  // namespace
}  // namespace halocline::channel_server
