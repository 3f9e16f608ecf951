// SPDX-License-Identifier: BSD-3-Clause
// Packets in a slow sea: the link's level and the sea's noise change over hours, and what link tables predict
// of an hour is what its packets do.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/noise/noise_variation.h"
#include "bus/config/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_table.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/channel_server/read_config.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using testing::name_of;

// Fading and noise by default, which change over minutes and hours.
struct SlowSea {
  acoustics::FadingModel fading;
  acoustics::NoiseVariation noise;
  std::uint64_t seed = 3;
};
SlowSea default_sea() {
  const ChannelServerConfig config = testing::read("");
  return {make_rays(config).fading, make_noise_variation(config.environment, bus::Scenario())};
}

VehicleModem coded_modem(double source_level_db) {
  VehicleModem modem = testing::quick_modem();
  modem.modem.source_level = Decibels{source_level_db};
  modem.modem.min_receivable_level = Decibels{-200};
  modem.modem.preamble = modem.modem.packet_overhead = SimDuration::from_milliseconds(100);
  modem.modem.error_model = acoustics::ErrorModel::kBpskHamming14;
  return modem;
}

// 1 sends to 2 over 750 m of even water along a straight line.
struct SlowLink {
  explicit SlowLink(double source_level_db, const SlowSea& slow_sea = default_sea())
      : sea(slow_sea),
        fleet({for_s(0.05), for_s(5)}, {coded_modem(source_level_db), {}}),
        propagation(std::make_shared<EnvironmentTimeline>(testing::even_water()), sea.fading),
        medium(fleet, propagation, {.seed = sea.seed, .fading = sea.fading, .noise = sea.noise}),
        predictor({.payload_bytes = 8,
                   .fading = sea.fading,
                   .profiles = {},
                   .noise = sea.noise,
                   .seed = sea.seed}) {}

  // Sends a packet at `start_s`, later than all before; true when it arrives.
  bool delivers(double start_s) {
    for (double time_s = start_s - 0.2; time_s < start_s + 2.5; time_s += 0.5) {
      if (time_s <= known_until_s) continue;
      known_until_s = time_s;
      for (const VehicleId id : {1, 2}) {
        const StampedState state = testing::state_at(time_s, {id == 1 ? 0.0 : 750.0, 0, 50});
        EXPECT_EQ(fleet.add_state(name_of(id), id, state), "");
      }
    }
    EXPECT_FALSE(medium.transmit(testing::request_of(1, start_s, ++sequence, 8), at_s(start_s)));
    bool received = false;
    for (const PacketOutcome& outcome : testing::outcomes_in(medium.advance_to(at_s(start_s + 2))))
      received = received || outcome.kind == OutcomeKind::kReceived;
    fleet.forget_before(at_s(start_s - 60));
    return received;
  }

  struct Hour {
    double realised = 0, predicted = 0;
  };
  // Sends packets for an hour from `begin_s` on.
  Hour hour(double begin_s, int packets) {
    Hour means;
    for (int i = 0; i < packets; ++i) {
      const double start_s = begin_s + 3600.0 * i / packets;
      means.realised += delivers(start_s) ? 1.0 / packets : 0;
      means.predicted += forecast_at(start_s).delivery_probability / packets;
    }
    return means;
  }
  LinkForecast forecast_at(double time_s) {
    const auto placed = place_all(fleet, at_s(time_s));
    EndPair link{link_end(placed[0]), link_end(placed[1])};
    link.to.above_ambient = noise_offset(sea.noise, sea.seed, at_s(time_s));
    const Reception reception = propagation.reception(at_s(time_s), link.from, link.to);
    return predictor.forecast(*predictor.rates_of(*link.from.modem), *link.from.modem, *link.to.modem,
                              reception, predictor.slow_state(1, 2, at_s(time_s)));
  }

  SlowSea sea;
  double known_until_s = -1;
  VehicleRegistry fleet;
  StraightPropagation propagation;
  PacketMedium medium;
  LinkPredictor predictor;
  std::int64_t sequence = 0;
};

// 1200 packets an hour, whose outcomes follow fading of minutes: a share moves by 0.2 or so with X, whose
// mean over an hour has the deviation sqrt(2 * 120 / 3600) = 0.26 of one instant's, so by 0.05; bound at 4,
// at 3 for the mean of eight. The hours differ by the slow sea, which the forecasts follow.
TEST(SlowSeaPackets, TheSharesOfHoursAreThoseThatTheirForecastsPredict) {
  SlowLink link(104);
  double difference = 0, least = 1, most = 0;
  constexpr int kHours = 8;
  for (int hour = 0; hour < kHours; ++hour) {
    const SlowLink::Hour means = link.hour(10 + 12'000.0 * hour, 1200);
    EXPECT_NEAR(means.realised, means.predicted, 0.2) << hour;
    difference += (means.realised - means.predicted) / kHours;
    least = std::min(least, means.predicted);
    most = std::max(most, means.predicted);
  }
  EXPECT_NEAR(difference, 0, 0.06);
  EXPECT_GT(most - least, 0.3);
}

// 10 000 packets an hour in a sea whose level over minutes is another for each of them: shares of 10 000 have
// a deviation of 0.005, so 0.02 is four of these.
TEST(SlowSeaPackets, AnHoursShareIsItsForecastWithinTwoPercent) {
  SlowSea sea = default_sea();
  sea.fading.large_scale_time_s = sea.fading.medium_coherence_s = 0.1;
  constexpr int kPackets = 10'000;
  SlowLink link(104, sea);
  for (int hour = 0; hour < 5; ++hour) {
    const SlowLink::Hour means = link.hour(10 + 20'000.0 * hour, kPackets);
    EXPECT_NEAR(means.realised, means.predicted, 0.02) << hour;
  }
}

// How shares of bins of two hours vary on links of one level.
struct BinStatistics {
  double mean = 0, variance_ratio = 0, correlation = 0;  // of shares; over the binomial; at two hours
};

BinStatistics bin_statistics(double source_level_db, SlowSea sea) {
  constexpr int kLinks = 20, kBins = 120, kPackets = 20;  // ten days, a packet each 360 s
  BinStatistics mean;
  for (int n = 0; n < kLinks; ++n) {
    sea.seed = 100 + static_cast<std::uint64_t>(n);
    SlowLink link(source_level_db, sea);
    std::vector<double> shares(kBins);
    double all = 0;
    for (int i = 0; i < kBins * kPackets; ++i) {
      const double received = link.delivers(10 + 360.0 * i) ? 1 : 0;
      shares[static_cast<std::size_t>(i / kPackets)] += received / kPackets;
      all += received / (kBins * kPackets);
    }
    double squares = 0, products = 0;
    for (std::size_t i = 0; i < kBins; ++i) {
      squares += (shares[i] - all) * (shares[i] - all);
      if (i > 0) products += (shares[i] - all) * (shares[i - 1] - all);
    }
    mean.mean += all / kLinks;
    mean.variance_ratio += squares / (kBins - 1) / (all * (1 - all) / kPackets) / kLinks;
    mean.correlation += products / squares / kLinks;
  }
  return mean;
}

// Source levels of links that deliver 0.2 to 0.8.
constexpr std::array<double, 5> kLevelsDb{97, 100.5, 102.2, 104, 108};

// At sea detections and packets have 3 to 7 times the binomial variance over 2 h, correlated by 0.2 to 0.65.
TEST(SlowSeaPackets, VaryOverHoursAsAtSea) {
  for (const double level_db : kLevelsDb) {
    const BinStatistics bins = bin_statistics(level_db, default_sea());
    EXPECT_GT(bins.variance_ratio, 2) << level_db;
    EXPECT_LT(bins.variance_ratio, 8) << level_db;
    EXPECT_GT(bins.correlation, 0.15) << level_db;
    EXPECT_LT(bins.correlation, 0.65) << level_db;
  }
}

TEST(SlowSeaPackets, VaryByChanceAloneWithoutSlowFadingAndNoise) {
  SlowSea sea = default_sea();
  sea.fading.slow = {};
  sea.noise.spread_db = 0;
  for (const double level_db : kLevelsDb) {
    const BinStatistics bins = bin_statistics(level_db, sea);
    EXPECT_GT(bins.variance_ratio, 0.8) << level_db;
    EXPECT_LT(bins.variance_ratio, 1.3) << level_db;
  }
}

}  // namespace
}  // namespace halocline::channel_server
