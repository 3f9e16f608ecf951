// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/modems/modem_config.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/modem/beam_pattern.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/modem/modem.h"
#include "acoustics/modem/receiver_kind.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/vehicles/modem_rates.h"
#include "core/check.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/channel_server/read_config.h"

namespace halocline::channel_server {
namespace {

using testing::errors_of;
using testing::for_s;
using ::testing::HasSubstr;
using testing::read;

TEST(ModemConfig, AVehiclesModemDiffersFromTheStandardOneInItsOwnKeys) {
  const auto config = read(
      "[modem]\nsource_level_db = 170\nbit_rate_bps = 300\n"
      "[[vehicle]]\nname = \"a\"\nid = 1\n"
      "[[vehicle]]\nname = \"b\"\nid = 2\n[vehicle.modem]\nsource_level_db = 190\n");
  const auto modems = make_modems(config);
  EXPECT_EQ(modems.of("a").modem.source_level.value, 170);
  EXPECT_EQ(modems.of("b").modem.source_level.value, 190);
  EXPECT_EQ(modems.of("b").modem.bit_rate_bps, 300);
}

TEST(ModemConfig, AProfileSetsWhatTheOtherKeysThenChange) {
  const VehicleModem modem =
      read("[modem]\nsource_level_db = 170\nguard_time_s = 0.02\nprofile = \"janus\"\n").modem;
  acoustics::Modem expected = load_modem("janus").modem;
  expected.source_level = {170};
  expected.guard_time = for_s(0.02);
  EXPECT_EQ(modem.modem, expected);
  EXPECT_EQ(modem.max_payload_bytes, 4096);
}

TEST(ModemConfig, AGuardTimeAloneTakesItsTaperWithIt) {
  const acoustics::Modem modem = read("[modem]\nprofile = \"janus\"\nguard_time_s = 0.02\n").modem.modem;
  EXPECT_EQ(modem.guard_taper_or_default(), for_s(0.02));
}

TEST(ModemConfig, AFamilyIsAName) {
  const std::string errors = errors_of("[modem]\n\nfamily = \"two words\"\n");
  EXPECT_THAT(errors, HasSubstr(":3: "));
  EXPECT_THAT(errors, HasSubstr("family"));
  EXPECT_THAT(errors, HasSubstr("a-z"));
}

TEST(ModemConfig, EveryPhysicalParameterOfAProfileCanBeChanged) {
  const auto modem =
      read(
          "[modem]\nprofile = \"micromodem-psk-1\"\nsource_level_db = 150\ncutoff_level_db = 30\n"
          "center_frequency_hz = 10000\nbandwidth_hz = 2000\ndirectivity_index_db = 3\n"
          "family = \"psk-of-our-own\"\nguard_time_s = 0.5\nguard_taper_s = 0.25\ndoppler_tolerance = 0.01\n"
          "doppler_correction = 0.02\ntime_quantum_s = 0.001\nerror_model = \"dbpsk-rayleigh\"\n"
          "receiver = \"strongest-path\"\nreceiver_loss_db = 2\nreceiver_channels = 3\n"
          "late_echo_share = 0.5\necho_cancelled = 0.25\nimpulse_loss_db = 4\n"
          "max_payload_bytes = 10\nwhen_busy = \"queue\"\n")
          .modem;
  acoustics::Modem expected = load_modem("micromodem-psk-1").modem;
  expected.source_level = {150};
  expected.min_receivable_level = {30};
  expected.centre_frequency_hz = 10'000;
  expected.bandwidth_hz = 2000;
  expected.directivity_index = {3};
  expected.guard_time = for_s(0.5);
  expected.family = "psk-of-our-own";
  expected.guard_taper = for_s(0.25);
  expected.doppler_tolerance = 0.01;
  expected.doppler_correction = 0.02;
  expected.time_quantum = for_s(0.001);
  expected.error_model = acoustics::ErrorModel::kDbpskRayleigh;
  expected.receiver = acoustics::ReceiverKind::kStrongestPath;
  expected.receiver_loss = {2};
  expected.receiver_channels = 3;
  expected.late_echo_share = 0.5;
  expected.echo_cancelled = 0.25;
  expected.impulse_loss = {4};
  VehicleModem all{expected, 10, WhenBusy::kQueue, "micromodem-psk-1", 1};
  set_rates_of(load_modem("micromodem-psk-1"), all);
  EXPECT_EQ(modem, all);
}

// Rates of the same waveform have the vehicle's band and family, and their own framing; those of another keep
// their band.
TEST(ModemConfig, TheRatesOfAProfileTakeTheVehiclesNumbers) {
  const auto modem =
      read(
          "[modem]\nprofile = \"micromodem-psk-1\"\nsource_level_db = 150\ncenter_frequency_hz = 10000\n"
          "family = \"psk-of-our-own\"\n")
          .modem;
  ASSERT_EQ(modem.rates.all().size(), 6u);
  const ModemRate& fsk = modem.rates.all()[0];
  const ModemRate& fast = modem.rates.all()[4];
  EXPECT_EQ(fsk.number, 0);
  EXPECT_EQ(fsk.modem.family, "micromodem-fsk");
  EXPECT_EQ(fsk.modem.centre_frequency_hz, 25'000);
  EXPECT_EQ(fsk.modem.source_level.value, 150);
  EXPECT_EQ(fast.number, 5);
  EXPECT_EQ(fast.modem.family, "psk-of-our-own");
  EXPECT_EQ(fast.modem.centre_frequency_hz, 10'000);
  EXPECT_EQ(fast.modem.bit_rate_bps, 5300);
  EXPECT_EQ(fast.modem.layout, load_modem("micromodem-psk-5").modem.layout);
  EXPECT_EQ(fast.max_payload_bytes, 2048);
}

TEST(ModemConfig, RatesAreFilesBesideAFileOrKnownByName) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "rates";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "slow.toml")
      << "family = \"mine\"\nbit_rate_bps = 10\nrates = \"fast.toml janus\"\n";
  std::ofstream(folder / "fast.toml") << "family = \"mine\"\nbit_rate_bps = 1000\nrate_number = 7\n";
  std::ofstream(folder / "wrong.toml") << "rates = \"fast.toml fast.toml\"\n";
  std::ofstream(folder / "lost.toml") << "rates = \"semaphore\"\n";
  const VehicleModem slow = load_modem((folder / "slow.toml").string());
  ASSERT_EQ(slow.rates.all().size(), 2u);
  EXPECT_EQ(slow.rates.all()[0].number, 7);
  EXPECT_EQ(slow.rates.all()[0].modem.bit_rate_bps, 1000);
  EXPECT_EQ(slow.rates.all()[1].modem.family, "janus");
  EXPECT_THROW(load_modem((folder / "wrong.toml").string()), InvalidArgument);
  EXPECT_THROW(load_modem((folder / "lost.toml").string()), InvalidArgument);
}

TEST(ModemConfig, AVehiclesProfileStartsFromItsOwnNumbers) {
  const auto config = read(
      "[modem]\nsource_level_db = 170\nwhen_busy = \"queue\"\n"
      "[[vehicle]]\nname = \"a\"\nid = 1\n[vehicle.modem]\nprofile = \"micromodem-psk-5\"\n"
      "[[vehicle]]\nname = \"b\"\nid = 2\n[vehicle.modem]\nprofile = \"generic\"\npreamble_s = 0.5\n"
      "packet_overhead_s = 0.5\n");
  const auto modems = make_modems(config);
  EXPECT_EQ(modems.of("a").modem, load_modem("micromodem-psk-5").modem);
  EXPECT_EQ(modems.of("a").max_payload_bytes, 2048);
  EXPECT_EQ(modems.of("a").when_busy, WhenBusy::kQueue);
  EXPECT_EQ(modems.of("b").modem.source_level.value,
            170);  // the same profile as the scenario's: no new start
  EXPECT_EQ(modems.of("b").modem.preamble, for_s(0.5));
}

TEST(ModemConfig, AProfileKeepsItsOwnPackets) {
  EXPECT_THAT(errors_of("[modem]\nprofile = \"janus\"\nbit_rate_bps = 300\n"), HasSubstr("bit rate"));
  EXPECT_THAT(errors_of("[modem]\nprofile = \"janus\"\npacket_overhead_s = 3\n"), HasSubstr("overhead"));
  EXPECT_THAT(errors_of("[modem]\nprofile = \"janus\"\nframe_bytes = 32\n"), HasSubstr("frame_bytes"));
  EXPECT_THAT(errors_of("[modem]\nprofile = \"semaphore\"\n"), HasSubstr("janus, micromodem-fsk"));
  EXPECT_THAT(errors_of("[modem]\npreamble_s = 0.1\n"), HasSubstr("packet_overhead_s"));
  EXPECT_EQ(errors_of("[modem]\nprofile = \"janus\"\nbit_rate_bps = 80\n"), "");
}

TEST(ModemConfig, ABeamIsATableInDegreesThatAVehicleInheritsOrReplaces) {
  const auto config = read(
      "[modem]\nbeam_elevation_deg = [-30, 0, 30]\nbeam_loss_db = [20, 0, 10]\n"
      "[[vehicle]]\nname = \"a\"\nid = 1\n[vehicle.modem]\nsource_level_db = 170\n"
      "[[vehicle]]\nname = \"b\"\nid = 2\n[vehicle.modem]\nbeam_loss_db = [3, 2, 1]\n"
      "[[vehicle]]\nname = \"c\"\nid = 3\n[vehicle.modem]\nbeam_elevation_deg = []\nbeam_loss_db = []\n");
  const double edge = to_radians(30);
  const acoustics::BeamPattern scenarios({{-edge, 20}, {0, 0}, {edge, 10}});
  EXPECT_EQ(config.modem.modem.beam, scenarios);
  const auto modems = make_modems(config);
  EXPECT_EQ(modems.of("a").modem.beam, scenarios);
  EXPECT_EQ(modems.of("b").modem.beam, acoustics::BeamPattern({{-edge, 3}, {0, 2}, {edge, 1}}));
  EXPECT_EQ(modems.of("c").modem.beam, acoustics::BeamPattern());
}

TEST(ModemConfig, AnImpossibleBeamIsRefusedWithFileLineAndKey) {
  const std::string uneven = errors_of("[modem]\nbeam_elevation_deg = [0, 30]\nbeam_loss_db = [1]\n");
  EXPECT_THAT(uneven, HasSubstr("test.toml:3"));
  EXPECT_THAT(uneven, HasSubstr("beam_loss_db"));
  const std::string falls = errors_of("[modem]\n\nbeam_elevation_deg = [30, 0]\nbeam_loss_db = [1, 2]\n");
  EXPECT_THAT(falls, HasSubstr("test.toml:3"));
  EXPECT_THAT(falls, HasSubstr("beam_elevation_deg"));
  EXPECT_THAT(falls, HasSubstr("does not rise"));
  EXPECT_THAT(errors_of("[modem]\nbeam_elevation_deg = [95]\nbeam_loss_db = [1]\n"),
              HasSubstr("beam_elevation_deg"));
  EXPECT_THAT(errors_of("[modem]\nbeam_elevation_deg = [9]\nbeam_loss_db = [201]\n"),
              HasSubstr("beam_loss_db"));
  EXPECT_THAT(errors_of("[modem]\nbeam_loss_db = [1]\n"), HasSubstr("beam_loss_db"));
}

TEST(ModemConfig, ABeamPrintedReadsBackTheSame) {
  ChannelServerConfig config;
  config.modem.modem.beam = acoustics::BeamPattern({{-0.123456789, 20}, {to_radians(12.3), 0.1}});
  const std::string printed = bus::to_toml([&](bus::ConfigVisitor& v) { visit(v, config); }, true);
  EXPECT_EQ(read(printed).modem, config.modem);
}

}  // namespace
}  // namespace halocline::channel_server
