// SPDX-License-Identifier: BSD-3-Clause
// The modems of models/modems.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/modem/bit_error.h"
#include "acoustics/modem/modem.h"
#include "acoustics/modem/packet_format.h"
#include "acoustics/modem/receiver_kind.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using channel_server::built_in_modems;
using channel_server::load_modem;
using channel_server::parse_modem;
using ::testing::HasSubstr;

Modem modem_of(const std::string& profile) { return load_modem(profile).modem; }

const std::filesystem::path kFolder = std::filesystem::path(HALOCLINE_SOURCE_DIR) / "models/modems";

std::string error_of(const std::string& toml) {
  try {
    parse_modem(toml, "a.toml");
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(ModemProfile, EveryFileOfTheFolderIsKnownByItsName) {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(kFolder))
    names.push_back(file.path().stem().string());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(built_in_modems(), names);
  for (const std::string& name : names) {
    const std::string path = (kFolder / (name + ".toml")).string();
    channel_server::VehicleModem by_path = load_modem(path);
    EXPECT_EQ(by_path.profile, path);
    by_path.profile = name;
    EXPECT_EQ(by_path, load_modem(name));
  }
}

// Every key with its value, a note of unit and range, and a source that the head of the file explains.
TEST(ModemProfile, EveryFileGivesEveryNumberWithItsSource) {
  for (const std::string& name : built_in_modems()) {
    std::ifstream file(kFolder / (name + ".toml"));
    std::string line, head;
    int keys = 0;
    while (std::getline(file, line)) {
      if (line.starts_with("#")) {
        head += line + "\n";
        continue;
      }
      ++keys;
      const std::size_t note = line.find('#'), source = line.rfind('[');
      ASSERT_NE(note, std::string::npos) << name << ": " << line;
      ASSERT_NE(source, std::string::npos) << name << ": " << line;
      EXPECT_THAT(head, HasSubstr("# " + line.substr(source))) << name << ": " << line;
    }
    EXPECT_EQ(keys, 34) << name;
  }
}

TEST(ModemProfile, UncodedIsTheDefaultOfTheStruct) {
  Modem uncoded = load_modem("uncoded").modem;
  uncoded.family = "generic";
  EXPECT_EQ(uncoded, Modem{});
}

TEST(ModemProfile, GenericIsCodedAndHoppedAsTheMicromodem) {
  const Modem generic = modem_of("generic"), micromodem = modem_of("micromodem-fsk");
  EXPECT_EQ(generic.error_model, micromodem.error_model);
  EXPECT_EQ(generic.chip, micromodem.chip);
  EXPECT_EQ(generic.hop_count, micromodem.hop_count);
  EXPECT_EQ(generic.hop_clearing, micromodem.hop_clearing);
  EXPECT_EQ(generic.receiver, micromodem.receiver);
  EXPECT_EQ(generic.receiver_loss, micromodem.receiver_loss);
}

// A receiver loses to the theory of its curve, not to a curve of its maker; four hydrophones are the PSK's.
TEST(ModemProfile, ReceiversLoseToTheoryAlone) {
  for (const std::string& name : built_in_modems()) {
    const Modem modem = modem_of(name);
    const double loss_db = name == "nm3" || name == "uncoded" ? 0 : name == "fish-tag-69khz" ? 12 : 3;
    EXPECT_EQ(modem.receiver_loss.value, loss_db) << name;
    EXPECT_EQ(modem.receiver_channels, name.starts_with("micromodem-psk") ? 4 : 1) << name;
    EXPECT_EQ(modem.late_echo_share, modem.receiver == ReceiverKind::kStrongestPath ? 0.5 : 1) << name;
    if (modem.receiver == ReceiverKind::kHops) {
      EXPECT_TRUE(is_frequency_shift_keying(modem.error_model)) << name;
    }
  }
}

TEST(ModemProfile, EveryFileStatesARangeThatItsSourcePublishes) {
  for (const std::string& name : built_in_modems()) {
    std::ifstream file(kFolder / (name + ".toml"));
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    EXPECT_THAT(text, HasSubstr("Range, published:")) << name;
  }
}

TEST(ModemProfile, WhatAFileLeavesOutIsTheGenericModems) {
  const Modem modem = parse_modem("bit_rate_bps = 160", "a.toml").modem;
  Modem expected;
  expected.bit_rate_bps = 160;
  EXPECT_EQ(modem, expected);
}

TEST(ModemProfile, AFileMayHoldABeamPattern) {
  const Modem modem = parse_modem("beam_elevation_deg = [-90, 0]\nbeam_loss_db = [20, 0]", "a.toml").modem;
  EXPECT_EQ(modem.beam.rows().size(), 2U);
}

TEST(ModemProfile, ErrorsOfAFileNameFileKeyAndWhatIsAllowed) {
  EXPECT_THAT(error_of("bandwith_hz = 1"), HasSubstr("bandwith_hz"));
  EXPECT_THAT(error_of("preamble_pieces = 0"), HasSubstr("preamble_pieces"));
  EXPECT_THAT(error_of("frame_bytes = 32"), HasSubstr("frames of a packet"));
  EXPECT_THAT(error_of("preamble_s = 0.1"), HasSubstr("packet_overhead_s"));
  EXPECT_THAT(error_of("bandwidth_hz = 60000"), HasSubstr("twice center_frequency_hz"));
  EXPECT_THAT(error_of("when_busy = \"queue\""), HasSubstr("a.toml:1"));
  EXPECT_THROW(load_modem("semaphore"), InvalidArgument);
  EXPECT_THROW(load_modem((kFolder / "missing.toml").string()), InvalidArgument);
}

TEST(ModemProfile, AChipAndAPatternBelongToHopping) {
  EXPECT_THAT(error_of("bit_rate_bps = 80\nhop_count = 13"), HasSubstr("a.toml:2: hop_count"));
  EXPECT_EQ(error_of("hop_count = 13\nchip_s = 0.01\nhop_clearing_s = 0.01"), "");
}

// Chip i of JANUS is on pair b (u + v b) mod 13, b = 2^(1 + i mod 12), u = 1 + i div 156, v = i div 12 (its
// reference implementation).
int janus_pair(int i) {
  int b = 1;
  for (int power = 0; power <= i % 12; ++power) b = 2 * b % 13;
  return b * (1 + i / 156 + i / 12 * b) % 13;
}

TEST(ModemProfile, JanusHopsToTheSamePairAfterAChipAsAfterAnyOther) {
  const Modem janus = modem_of("janus");
  EXPECT_EQ(janus.hop_clearing, SimDuration());
  constexpr int kChips = 12 * 13 * 13;  // the pattern repeats
  for (int late = 1; late <= 40; ++late) {
    int met = 0;
    for (int i = 0; i < kChips; ++i) met += janus_pair(i) == janus_pair((i + late) % kChips);
    const double share = static_cast<double>(met) / kChips;
    if (late % 12 == 0) {
      EXPECT_LT(share, 0.02) << late;
    } else {
      EXPECT_NEAR(share, 1.0 / janus.hop_count, 0.003) << late;
    }
  }
}

TEST(ModemProfile, RealModemsHaveADetectorAndNoCutOff) {
  for (const std::string& name : built_in_modems()) {
    const Modem modem = modem_of(name);
    const bool is_ideal = name == "generic" || name == "uncoded";
    EXPECT_EQ(modem.min_receivable_level.value, is_ideal ? 70 : -200) << name;
    // The pulses of a tag are their own detector.
    EXPECT_EQ(modem.preamble > SimDuration(), !is_ideal && name != "fish-tag-69khz") << name;
  }
}

TEST(ModemProfile, TheRatesOfPskAreOneFamily) {
  EXPECT_TRUE(same_family(modem_of("micromodem-psk-1"), modem_of("micromodem-psk-5")));
  EXPECT_FALSE(same_family(modem_of("micromodem-psk-1"), modem_of("micromodem-fsk")));
}

TEST(ModemProfile, JanusPacketsLastAsInTheReference) {
  const Modem janus = modem_of("janus");
  for (const testing::CsvRow& row : testing::read_reference_csv("acoustics/janus_frame_durations.csv")) {
    const auto bits = static_cast<std::int64_t>(row.number("payload_bits"));
    const PacketTiming timing = packet_timing(janus, static_cast<std::size_t>((bits - 64) / 8));
    EXPECT_NEAR(timing.duration.seconds(), row.number("duration_s"), 1e-9) << row.line();
    EXPECT_NEAR(timing.duration.seconds() / row.number("chip_duration_s"), row.number("total_chips"), 1e-6);
    EXPECT_NEAR(timing.preamble.seconds() / row.number("chip_duration_s"), row.number("preamble_chips"),
                1e-9);
    EXPECT_EQ(timing.information_bits, bits);
    EXPECT_EQ(janus.centre_frequency_hz, row.number("fc_Hz"));
    EXPECT_EQ(janus.bandwidth_hz, row.number("bandwidth_Hz"));
  }
}

// Published: a baseline packet of 176 chips lasts 1.100 s, and N bytes of cargo 0.1 (N + 1) s more.
TEST(ModemProfile, JanusBaselineAndCargoLastAsPublished) {
  const Modem janus = modem_of("janus");
  EXPECT_EQ(janus.layout.application_bits, 34);
  EXPECT_EQ(packet_timing(janus, PacketFormat{64, {0}}).duration, SimDuration::from_milliseconds(1100));
  EXPECT_EQ(packet_timing(janus, 0).duration, SimDuration::from_milliseconds(1100));
  EXPECT_EQ(packet_timing(janus, 0).information_bits, 64);
  for (const std::int64_t cargo : {1, 8, 100}) {
    EXPECT_EQ(packet_timing(janus, PacketFormat{64, {0, 8 * cargo}}).duration,
              SimDuration::from_milliseconds(1100 + 100 * (cargo + 1)));
  }
}

// Of a published table of durations on the water: 1, 8, 16 and 29 bytes. The line of 976 bit/s runs below it
// at the long end.
TEST(ModemProfile, InstantMessagesOfS2cLastAsPublished) {
  const Modem modem = modem_of("s2c-im");
  const std::vector<std::pair<std::size_t, double>> published{
      {1, 0.172}, {8, 0.238}, {16, 0.328}, {29, 0.468}};
  for (const auto& [bytes, duration_s] : published)
    EXPECT_NEAR(packet_timing(modem, bytes).duration.seconds() / duration_s, 0.93, 0.08) << bytes;
  EXPECT_EQ(max_payload_bytes(modem), static_cast<std::size_t>(kMaxPayloadBytes));
  EXPECT_EQ(load_modem("s2c-im").max_payload_bytes, 64);
}

// 0.105 s and 12.5 ms a byte, 16 of parity; a ping is the 0.105 s alone.
TEST(ModemProfile, NanomodemMessagesLastAsItsProgramsSay) {
  const Modem modem = modem_of("nm3");
  EXPECT_EQ(packet_timing(modem, 0).duration, SimDuration::from_milliseconds(105));
  EXPECT_EQ(packet_timing(modem, 64).duration, SimDuration::from_milliseconds(1105));
  EXPECT_EQ(packet_timing(modem, 4).duration, SimDuration::from_milliseconds(355));
}

TEST(ModemProfile, AMiniPacketIsShorterThanAnyOther) {
  const Modem modem = modem_of("micromodem-fsk");
  EXPECT_EQ(packet_timing(modem, *mini_format(modem)).duration, SimDuration::from_milliseconds(700));
  EXPECT_FALSE(mini_format(modem_of("micromodem-psk-1")));
}

TEST(ModemProfile, AModemHasTheOtherRatesOfItsDevice) {
  const auto numbers_of = [](const std::string& profile) {
    std::vector<std::int32_t> numbers;
    const channel_server::VehicleModem modem = load_modem(profile);
    for (const auto& rate : modem.rates.all()) numbers.push_back(rate.number);
    return numbers;
  };
  EXPECT_EQ(load_modem("micromodem-psk-4").rate_number, 4);
  EXPECT_THAT(numbers_of("micromodem-psk-4"), ::testing::ElementsAre(0, 1, 2, 3, 5, 6));
  EXPECT_THAT(numbers_of("micromodem-fsk"), ::testing::IsEmpty());
  EXPECT_THAT(numbers_of("unet-control"), ::testing::ElementsAre(2));
  EXPECT_THAT(numbers_of("s2c-burst"), ::testing::ElementsAre(0));
  for (const std::string& name : built_in_modems()) {
    const channel_server::VehicleModem modem = load_modem(name);
    for (const auto& rate : modem.rates.all()) EXPECT_NO_THROW(validate(rate.modem)) << name;
  }
}

TEST(ModemProfile, MicromodemPacketsHoldTheFramesOfTheirType) {
  struct Type {
    Modem modem;
    std::size_t frame, most;
  };
  const Type types[] = {{modem_of("micromodem-fsk"), 32, 32},     {modem_of("micromodem-psk-1"), 64, 192},
                        {modem_of("micromodem-psk-2"), 64, 192},  {modem_of("micromodem-psk-3"), 256, 512},
                        {modem_of("micromodem-psk-4"), 256, 512}, {modem_of("micromodem-psk-5"), 256, 2048},
                        {modem_of("micromodem-psk-6"), 32, 192}};
  for (const Type& type : types) {
    EXPECT_EQ(max_payload_bytes(type.modem), type.most);
    EXPECT_EQ(packet_timing(type.modem, 1).information_bits, static_cast<std::int64_t>(8 * type.frame));
    EXPECT_EQ(packet_timing(type.modem, type.most).information_bits,
              static_cast<std::int64_t>(8 * type.most));
  }
}

// WHOI calls the burst rate of a full packet of rate 5 about 5000 bit/s, preamble and all.
TEST(ModemProfile, AFullPacketOfRateFiveBurstsAtAboutFiveThousandBitsASecond) {
  const Modem modem = modem_of("micromodem-psk-5");
  const double rate_bps = 8 * 2048 / packet_timing(modem, 2048).duration.seconds();
  EXPECT_NEAR(rate_bps, 5000, 250);
}

TEST(ModemProfile, ErrorsFallAsTheRatioRisesForEveryProfile) {
  for (const std::string& name : built_in_modems()) {
    const Modem modem = modem_of(name);
    double before = bit_error_rate(modem, {0});
    EXPECT_DOUBLE_EQ(before, modem.error_model == ErrorModel::kPulses ? 0.999 : 0.5) << name;
    for (int step = -400; step <= 400; ++step) {
      const double now = bit_error_rate(modem, to_power_ratio(Decibels{step * 0.1}));
      ASSERT_LE(now, before) << name << " at " << step * 0.1 << " dB";
      before = now;
    }
    EXPECT_LT(before, 1e-12) << name;
  }
}

// Detection should not limit reception: where half the packets decode, nearly all are detected.
TEST(ModemProfile, PacketsAreDetectedWhereTheyDecode) {
  for (const std::string& name : built_in_modems()) {
    const Modem modem = modem_of(name);
    const std::int64_t bits =
        packet_timing(modem, std::min<std::size_t>(32, max_payload_bytes(modem))).information_bits;
    double db = -40;
    while (packet_error_rate(bit_error_rate(modem, to_power_ratio(Decibels{db})), bits) > 0.5) db += 0.1;
    EXPECT_GT(acquisition_probability(modem, to_power_ratio(Decibels{db})), 0.99) << name;
  }
}

// The ratio at which half of the frames are wrong.
double half_of_frames_db(const Modem& modem, std::int64_t frame_bits) {
  double low = -40, high = 40;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    const double error = bit_error_rate(modem, to_power_ratio(Decibels{middle}));
    (packet_error_rate(error, frame_bits) > 0.5 ? low : high) = middle;
  }
  return low;
}

// WHOI's public simulation package (ros_acomms, packet performance) gives frame errors against the ratio:
// half of the frames at -7.05 dB for rate 1 (between 72.7 % at -7.23 and 17 % at -6.85 dB) and at 3.87 dB for
// rate 5 (between 100 % at 3.10 and 13.5 % at 4.44 dB). 2 dB: whether its ratio is over 4 or 5 kHz (1 dB) is
// not stated, and bits that err in clumps spoil fewer frames than as many single ones (0.4 dB at rate 5).
TEST(ModemProfile, PskFramesFailWhereThePublishedCurvesSay) {
  EXPECT_NEAR(half_of_frames_db(modem_of("micromodem-psk-1"), 512), -7.05, 2);
  EXPECT_NEAR(half_of_frames_db(modem_of("micromodem-psk-5"), 2048), 3.87, 2);
}

// Rate 3 spreads and has no code, so it needs more than the coded rate 4.
TEST(ModemProfile, FasterRatesNeedMore) {
  for (const std::vector<std::string>& rates :
       {std::vector<std::string>{"1", "2", "3"}, std::vector<std::string>{"1", "6", "4", "5"}}) {
    double before = -40;
    for (const std::string& rate : rates) {
      const double now = half_of_frames_db(modem_of("micromodem-psk-" + rate), 512);
      EXPECT_GT(now, before) << rate;
      before = now;
    }
  }
}

// A vehicle may meet another at 2 m/s each in every profile; the reference receivers correct no more than 5
// m/s.
TEST(ModemProfile, VehiclesAreWithinTheDopplerTolerance) {
  for (const std::string& name : built_in_modems()) {
    const Modem modem = modem_of(name);
    EXPECT_GT(modem.doppler_tolerance, 4.0 / 1500) << name;
    if (name != channel_server::kGenericProfile && name != "uncoded") {
      EXPECT_LT(modem.doppler_tolerance, 6.0 / 1500) << name;
    }
  }
}

}  // namespace
}  // namespace halocline::acoustics
