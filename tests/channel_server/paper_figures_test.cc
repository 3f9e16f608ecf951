// SPDX-License-Identifier: BSD-3-Clause
// Figures 4, 6 and 7 of Sehgal, Cernea and Birk 2010 through the channel server on the bus: static vehicles,
// LINKS and LINK_REPLY, against the reference tables and the numbers that are expected of them.
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "bus/transport/event_log.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "tests/channel_server/node_bench.h"
#include "tests/support/csv.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::read_reference_csv;
using halocline::testing::relative_error;
using halocline::testing::tolerance;
using testing::NodeBench;

// The tables' own precision, as for every reference row.
constexpr double kRelative = 1e-12, kDecibels = 1e-10, kCapacity = 1e-9;

VehicleModem modem_of(double strength_db, double low_khz, double high_khz) {
  VehicleModem modem;
  modem.modem =
      acoustics::generic_modem({strength_db}, {0}, 500 * (low_khz + high_khz), 1000 * (high_khz - low_khz));
  return modem;
}

// Two vehicles at rest; their link after a second.
link_t link_between(const Vec3& one, const Vec3& other, const VehicleModem& modem,
                    const acoustics::Environment& water) {
  bus::set_log_level(bus::LogLevel::kSilent);
  ServerRules rules;
  rules.reach.by_level = false;  // rows however quiet
  NodeBench bench(rules, {modem, {}}, water);
  bench.state(1, 0, one);
  bench.state(2, 0, other);
  bench.run_to(1);
  return bench.last_table(1).peers.at(0);
}

link_answer_t answer_between(const Vec3& one, const Vec3& other, const VehicleModem& modem,
                             const acoustics::Environment& water) {
  NodeBench bench({}, {VehicleModem(), {}}, water);
  link_end_t from{}, to{};
  for (int i = 0; i < 3; ++i) from.position_ned_m[i] = one[i], to.position_ned_m[i] = other[i];
  from.modem_choice = to.modem_choice = link_end_t::MODEM_GIVEN;
  from.modem = to.modem = to_message(modem, SimTime());
  link_query_t query{};
  query.client_name = "figures";
  query.num_links = 1;
  query.transmitters = {from};
  query.receivers = {to};
  bench.bus().publish("LINK_QUERY", query);
  bench.step(SimTime(), SimTime::from_seconds(1), /*known=*/false);
  bench.step(SimTime(), SimTime::from_seconds(2), /*known=*/false);
  return bench.replies.at(0).message.answers.at(0);
}

acoustics::Environment water_of(acoustics::SoundSpeedProfile profile) {
  acoustics::Environment water;
  water.profile = std::move(profile);
  return water;
}

double delay_1km_apart(double depth_m, const acoustics::Environment& water) {
  return link_between({0, 0, depth_m}, {1000, 0, depth_m}, VehicleModem(), water).delay_s;
}

TEST(Figure4, DelaysOverOneKilometreMatchTheReferenceAtEveryDepth) {
  const auto mean = water_of(acoustics::SoundSpeedProfile::global_mean());
  const auto mean_of_35 = water_of(acoustics::SoundSpeedProfile::global_mean_of_salinity_35());
  const auto harris = water_of(acoustics::SoundSpeedProfile::harris_zorzi());
  const auto munk = water_of(acoustics::SoundSpeedProfile::munk({10, 35}));
  for (const auto& row : read_reference_csv("acoustics/fig4_delay_vs_depth_1km.csv")) {
    const double depth_m = row.number("depth_m");
    const auto expect_delay = [&](const acoustics::Environment& water, const std::string& column) {
      EXPECT_LT(relative_error(delay_1km_apart(depth_m, water), row.number(column)), tolerance(kRelative))
          << column << " at " << depth_m << " m";
    };
    expect_delay(mean, "delay_woa98_s");
    expect_delay(mean_of_35, "delay_woa98_S35_s");
    expect_delay(harris, "delay_harris_s");
    if (depth_m <= 5000) expect_delay(munk, "delay_munk_s");
  }
}

TEST(Figure4, HasTheNumbersExpectedOfIt) {
  const auto mean = water_of(acoustics::SoundSpeedProfile::global_mean());
  // Six digits are given.
  EXPECT_NEAR(delay_1km_apart(0, mean), 0.660724, tolerance(5e-7));
  EXPECT_NEAR(delay_1km_apart(950, mean), 0.674539, tolerance(5e-7));
  EXPECT_NEAR(delay_1km_apart(4500, mean), 0.652978, tolerance(5e-7));
  EXPECT_GT(delay_1km_apart(950, mean), delay_1km_apart(750, mean));
  EXPECT_GT(delay_1km_apart(950, mean), delay_1km_apart(1450, mean));
}

TEST(Figures6And7, LevelsAndCapacitiesInTheTablesMatchTheReference) {
  for (const auto& row : read_reference_csv("acoustics/fig6_fig7_100m_depth.csv")) {
    acoustics::Environment water;
    water.noise = {row.number("shipping"), row.number("wind_m_per_s")};
    const auto modem =
        modem_of(row.number("Ptx_dB_re_1uPa_at_1m"), row.number("f_lo_kHz"), row.number("f_hi_kHz"));
    const auto link = link_between({0, 0, 100}, {row.number("range_m"), 0, 100}, modem, water);
    EXPECT_NEAR(link.transmission_loss_db, row.number("TL_fc_dB"), tolerance(kDecibels));
    EXPECT_NEAR(link.received_level_db, row.number("Prx_fc_dB_re_1uPa"), tolerance(kDecibels));
    EXPECT_LT(relative_error(link.capacity_bps, row.number("C_eq8_bit_per_s")), tolerance(kCapacity));
  }
}

TEST(Figures6And7, AnswersToQueriesMatchTheReference) {
  const auto rows = read_reference_csv("acoustics/fig6_fig7_100m_depth.csv");
  for (std::size_t i = 0; i < rows.size(); i += 5) {
    acoustics::Environment water;
    water.noise = {rows[i].number("shipping"), rows[i].number("wind_m_per_s")};
    const auto modem = modem_of(rows[i].number("Ptx_dB_re_1uPa_at_1m"), rows[i].number("f_lo_kHz"),
                                rows[i].number("f_hi_kHz"));
    const auto answer = answer_between({0, 0, 100}, {rows[i].number("range_m"), 0, 100}, modem, water);
    EXPECT_NEAR(answer.getss_received_strength_db, rows[i].number("Prx_fc_dB_re_1uPa"), tolerance(kDecibels));
    EXPECT_LT(relative_error(answer.getbw_capacity_kbps, rows[i].number("C_eq8_bit_per_s") / 1000),
              tolerance(kCapacity));
  }
}

TEST(Figures6And7, HaveTheNumbersExpectedOfThem) {
  const acoustics::Environment water;
  const auto near = link_between({0, 0, 100}, {4, 0, 100}, modem_of(120, 22.5, 27.5), water);
  const auto far = link_between({0, 0, 100}, {180, 0, 100}, modem_of(60, 22.5, 27.5), water);
  // The last digit given.
  EXPECT_NEAR(near.transmission_loss_db, 9.045, tolerance(5e-4));
  EXPECT_NEAR(far.transmission_loss_db, 34.459, tolerance(5e-4));
  EXPECT_NEAR(near.received_level_db, 110.955, tolerance(5e-4));
  EXPECT_NEAR(far.received_level_db, 25.541, tolerance(5e-4));
  EXPECT_NEAR(near.capacity_bps, 85'770, tolerance(5));
  EXPECT_NEAR(far.capacity_bps, 3.0, tolerance(0.05));
}

}  // namespace
}  // namespace halocline::channel_server
