// SPDX-License-Identifier: BSD-3-Clause
// Packets in a slow sea: the link's level and the sea's noise change over hours, and what link tables predict
// of an hour is what its packets do.
#include <algorithm>
#include <cstdint>
#include <memory>

#include <gtest/gtest.h>

#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/noise/noise_variation.h"
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

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using testing::name_of;

constexpr std::uint64_t kSeed = 3;
constexpr double kPeriodS = 3;  // between two packets

acoustics::FadingModel slow_fading() {
  acoustics::FadingModel fading{.enabled = true};
  fading.slow = {.deviation_db = 3, .time_s = 21600, .tidal_db = 1, .daily_db = 1};
  return fading;
}
constexpr acoustics::NoiseVariation kNoise{.spread_db = 3, .spread_time_s = 3600};

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
  explicit SlowLink(double source_level_db)
      : fleet({for_s(0.05), for_s(5)}, {coded_modem(source_level_db), {}}),
        propagation(std::make_shared<EnvironmentTimeline>(testing::even_water()), slow_fading()),
        medium(fleet, propagation, {.seed = kSeed, .fading = slow_fading(), .noise = kNoise}),
        predictor(
            {.payload_bytes = 8, .fading = slow_fading(), .profiles = {}, .noise = kNoise, .seed = kSeed}) {}

  struct Hour {
    double realised = 0, predicted = 0;
  };
  // Sends packets for an hour from `begin_s` on.
  Hour hour(double begin_s) {
    constexpr int kPackets = static_cast<int>(3600 / kPeriodS);
    Hour means;
    for (int i = 0; i < kPackets; ++i) {
      const double start_s = begin_s + kPeriodS * i;
      for (double time_s = start_s - 0.2; time_s < start_s + kPeriodS; time_s += 0.5) {
        for (const VehicleId id : {1, 2}) {
          const StampedState state = testing::state_at(time_s, {id == 1 ? 0.0 : 750.0, 0, 50});
          EXPECT_EQ(fleet.add_state(name_of(id), id, state), "");
        }
      }
      EXPECT_FALSE(medium.transmit(testing::request_of(1, start_s, ++sequence, 8), at_s(start_s)));
      for (const PacketOutcome& outcome : testing::outcomes_in(medium.advance_to(at_s(start_s + 2))))
        means.realised += outcome.kind == OutcomeKind::kReceived ? 1.0 / kPackets : 0;
      means.predicted += forecast_at(start_s).delivery_probability / kPackets;
      fleet.forget_before(at_s(start_s - 60));
    }
    return means;
  }
  LinkForecast forecast_at(double time_s) {
    const auto placed = place_all(fleet, at_s(time_s));
    EndPair link{link_end(placed[0]), link_end(placed[1])};
    link.to.above_ambient = noise_offset(kNoise, kSeed, at_s(time_s));
    const Reception reception = propagation.reception(at_s(time_s), link.from, link.to);
    return predictor.forecast(*predictor.rates_of(*link.from.modem), *link.from.modem, *link.to.modem,
                              reception, predictor.slow_state(1, 2, at_s(time_s)));
  }

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
    const SlowLink::Hour means = link.hour(10 + 12'000.0 * hour);
    EXPECT_NEAR(means.realised, means.predicted, 0.2) << hour;
    difference += (means.realised - means.predicted) / kHours;
    least = std::min(least, means.predicted);
    most = std::max(most, means.predicted);
  }
  EXPECT_NEAR(difference, 0, 0.06);
  EXPECT_GT(most - least, 0.3);
}

}  // namespace
}  // namespace halocline::channel_server
