// SPDX-License-Identifier: BSD-3-Clause
// Waveform families, and modems of one family whose bands overlap in part.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "channel_server/modems/modem_config.h"
#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "tests/channel_server/scripted_water.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::path;

class PacketFamilyTest : public testing::ScriptedWater {
 protected:
  void carry(VehicleId id, const VehicleModem& modem, double from_s = 0) {
    fleet.announce_modem(testing::name_of(id), at_s(from_s), modem, at_s(from_s));
  }
  // 5 kHz wide as the packet's, `share` of it within the packet's 22.5 to 27.5 kHz.
  static VehicleModem sharing(double share) {
    VehicleModem modem = big_modem();
    modem.modem.centre_frequency_hz += (1 - share) * modem.modem.bandwidth_hz;
    return modem;
  }
  static VehicleModem of_family(const std::string& family) {
    VehicleModem modem = big_modem();
    modem.modem.family = family;
    return modem;
  }
};

// Modems of phase-shift keying also receive the frequency-shift keying that is a rate of theirs, but not the
// other way round.
TEST_F(PacketFamilyTest, OfFiveModemsThoseWithARateInCommonReceiveEachOther) {
  const std::vector<std::string> profiles{"generic", "janus", "micromodem-fsk", "micromodem-psk-1",
                                          "micromodem-psk-5"};
  water.set(1, 2, {path(1, 140)});
  std::vector<std::pair<std::string, std::string>> pairs, received;
  for (const std::string& from : profiles) {
    for (const std::string& to : profiles) {
      if (from == to) continue;
      const double at = 1 + 5.0 * static_cast<double>(pairs.size());  // a packet takes 4 s at most
      carry(1, load_modem(from), at);
      carry(2, load_modem(to), at);
      send(1, at, static_cast<std::int64_t>(pairs.size()), 10);
      pairs.emplace_back(from, to);
    }
  }
  run(119);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const OutcomeKind kind = end_of(1, static_cast<std::int64_t>(i), 2).kind;
    if (kind == OutcomeKind::kReceived) {
      received.push_back(pairs[i]);
    } else {
      EXPECT_EQ(kind, OutcomeKind::kForeign) << pairs[i].first << " to " << pairs[i].second;
    }
  }
  EXPECT_THAT(received, ::testing::ElementsAre(std::pair("micromodem-fsk", "micromodem-psk-1"),
                                               std::pair("micromodem-fsk", "micromodem-psk-5"),
                                               std::pair("micromodem-psk-1", "micromodem-psk-5"),
                                               std::pair("micromodem-psk-5", "micromodem-psk-1")));
}

TEST_F(PacketFamilyTest, ANameThatNoProfileHasIsAFamilyOfItsOwn) {
  carry(1, of_family("sonobuoy-3"));
  carry(2, of_family("sonobuoy-3"));
  water.set(1, 2, {path(1, 120)});
  water.set(1, 3, {path(1, 120)});
  send(1, 10, 0, 10);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kReceived);
  EXPECT_EQ(end_of(1, 0, 3).kind, OutcomeKind::kForeign);
}

TEST_F(PacketFamilyTest, AForeignPacketIsNotFollowedAndInterferesByItsShareOfTheBand) {
  VehicleModem foreign = sharing(0.25);
  foreign.modem.family = "whistle";
  carry(3, foreign);
  water.set(1, 2, {path(1, 100)});
  water.set(3, 2, {path(1, 80)});
  send(3, 10, 5, 300);
  send(1, 11, 0, 100);  // while the foreign one lasts
  run();
  EXPECT_EQ(end_of(3, 5, 2).kind, OutcomeKind::kForeign);
  const PacketOutcome& end = end_of(1, 0, 2);
  EXPECT_EQ(end.kind, OutcomeKind::kReceived);
  EXPECT_NEAR(end.statistics.interference.value, 80 + 10 * std::log10(0.25), tolerance(1e-9));
  ASSERT_EQ(end.statistics.colliders.size(), 1u);
  EXPECT_EQ(end.statistics.colliders[0].source_id, 3);
}

TEST_F(PacketFamilyTest, AMissingShareOfTheBandCostsItsRatio) {
  water.set(1, 2, {path(1, 100)});
  const double whole_db = 100 - 10 * std::log10(noise_power());
  double at = 10;
  for (const double share : {1.0, 0.5, 0.1, 0.02}) {
    carry(2, sharing(share), at);
    send(1, at, static_cast<std::int64_t>(at), 1);
    at += 10;
  }
  run();
  at = 10;
  for (const double share : {1.0, 0.5, 0.1, 0.02}) {
    const PacketOutcome& end = end_of(1, static_cast<std::int64_t>(at), 2);
    EXPECT_NEAR(end.statistics.sinr.value, whole_db + 10 * std::log10(share), tolerance(1e-9)) << share;
    EXPECT_NEAR(end.budget.snr.value, whole_db + 10 * std::log10(share), tolerance(1e-9)) << share;
    EXPECT_EQ(end.kind, OutcomeKind::kReceived) << share;  // 20 dB even with 100 Hz of 5 kHz
    at += 10;
  }
}

TEST_F(PacketFamilyTest, AReceiverWithAWiderBandMissesNothing) {
  VehicleModem wide = big_modem();
  wide.modem.bandwidth_hz = 20'000;
  carry(2, wide);
  water.set(1, 2, {path(1, 100)});
  send(1, 10, 0, 1);
  run();
  EXPECT_NEAR(end_of(1, 0, 2).budget.snr.value, 100 - 10 * std::log10(noise_power()), tolerance(1e-9));
}

}  // namespace
}  // namespace halocline::channel_server
