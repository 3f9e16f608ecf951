// SPDX-License-Identifier: BSD-3-Clause
// Why a packet was lost: the five powers beside its signal, and the one without which it would have been
// likeliest to be received, found here by removing each with the same curves.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/reception/disturbing_powers.h"
#include "acoustics/reception/signal_history.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/packets/reception_decision.h"
#include "core/sim_time.h"

namespace halocline::channel_server {
namespace {

using acoustics::LossReason;

constexpr double kNone = 0;

// A packet of 32 bytes in four stretches of constant powers, relative to a signal of 1.
struct Powers {
  double noise = kNone, late = kNone, fast = kNone, others = kNone, impulses = kNone;
};

struct Lost {
  explicit Lost(const Powers& powers, double loss = 1, double channels = 1) {
    Packet packet;
    packet.modem = load_modem("micromodem-psk-1").modem;
    packet.format = data_format(packet.modem, 32);
    packet.timing = packet_timing(packet.modem, packet.format);
    const SimTime begin = SimTime::from_seconds(100);
    signal.packet = std::make_shared<const Packet>(packet);
    signal.noise = powers.noise;
    signal.impulses = powers.impulses;
    signal.begin = begin;
    signal.preamble_end = begin + packet.timing.preamble;
    signal.end = begin + packet.timing.duration;
    const double preamble_s = packet.timing.preamble.seconds(), end_s = packet.timing.duration.seconds();
    signal.history.edges_s = {0, preamble_s, (preamble_s + end_s) / 2, end_s};
    signal.history.signal.assign(3, 1);
    signal.history.echoes.assign(3, powers.late + powers.fast);
    signal.history.fast_fading.assign(3, powers.fast);
    signal.history.receiver = {loss, channels};
    if (powers.others > 0) {
      others.packets.push_back(signal.packet);
      others.paths.push_back({begin, signal.end, powers.others, 0});
    }
  }
  double success() const {
    return acquisition_probability(signal, others.paths) * success_probability(signal, others.paths);
  }
  // A draw that every packet but a certain one loses.
  DecisionStatistics decided() const {
    DecisionStatistics statistics;
    PacketDraws draws{0.999999, 0.999999, {}};
    draws.later_frames.assign(signal.packet->format.frame_bits.size(), 0.999999);
    const bool acquired = acquires(signal, others, draws, statistics);
    decide_reception(signal, others, draws, acquired, statistics);
    return statistics;
  }
  ReceivedSignal signal;
  Interferers others;
};

TEST(LossReason, PowersAreThoseBesideTheSignal) {
  const DecisionStatistics lost = Lost({0.1, 0.2, 0.3, 0.4, 0.5}, 2, 4).decided();
  EXPECT_NEAR(lost.powers.noise, 0.1 * 2 / 4, 1e-12);
  EXPECT_NEAR(lost.powers.late_echoes, 0.2 / 4, 1e-12);
  EXPECT_NEAR(lost.powers.fast_fading, 0.3 / 4, 1e-12);
  EXPECT_NEAR(lost.powers.others, 0.4 / 4, 1e-12);
  EXPECT_NEAR(lost.powers.impulses, 0.5 * 2 / 4, 1e-12);
  // They add up to 1 / SINR.
  EXPECT_NEAR(std::pow(10, -lost.sinr.value / 10), lost.powers.sum(), 1e-9);
}

// Each power in turn is the greatest by far.
TEST(LossReason, IsTheOnlyPowerThatMatters) {
  const double loud = 2, faint = 0.001;
  EXPECT_EQ(Lost({loud, faint, faint, faint, faint}).decided().reason, LossReason::kNoise);
  EXPECT_EQ(Lost({faint, loud, faint, faint, faint}).decided().reason, LossReason::kLateEchoes);
  EXPECT_EQ(Lost({faint, faint, loud, faint, faint}).decided().reason, LossReason::kFastFading);
  EXPECT_EQ(Lost({faint, faint, faint, loud, faint}).decided().reason, LossReason::kOtherPackets);
  EXPECT_EQ(Lost({faint, faint, faint, faint, loud}).decided().reason, LossReason::kImpulses);
}

// Removing each power and deciding anew, by the same curves, is what the reason claims.
TEST(LossReason, IsThePowerWithoutWhichSuccessWouldRiseMost) {
  int told = 0;
  for (const double noise : {0.3, 0.6, 1.0}) {
    for (const double late : {0.2, 0.5, 0.9}) {
      for (const double fast : {0.1, 0.4, 0.8}) {
        const Powers powers{noise, late, fast, 0.3, 0.2};
        std::vector<double> left;
        for (int k = 0; k < 5; ++k) {
          Powers without = powers;
          (k == 0   ? without.noise
           : k == 1 ? without.late
           : k == 2 ? without.fast
           : k == 3 ? without.others
                    : without.impulses) = kNone;
          left.push_back(Lost(without).success());
        }
        const auto best = std::max_element(left.begin(), left.end());
        if (!(*best > 1e-9)) continue;
        // Ties are nobody's claim.
        if (std::count_if(left.begin(), left.end(), [&](double p) { return p > *best - 1e-9; }) > 1) continue;
        ++told;
        EXPECT_EQ(static_cast<int>(Lost(powers).decided().reason), best - left.begin() + 1)
            << noise << " " << late << " " << fast;
      }
    }
  }
  EXPECT_GT(told, 10);
}

TEST(LossReason, OfTwoPowersThatLoseItAloneIsTheGreater) {
  EXPECT_EQ(Lost({.noise = 50, .late = 80}).decided().reason, LossReason::kLateEchoes);
  EXPECT_EQ(Lost({.noise = 80, .late = 50}).decided().reason, LossReason::kNoise);
}

TEST(LossReason, OfAReceivedPacketIsNone) {
  const Lost heard({.noise = 0.001});
  DecisionStatistics statistics;
  const PacketDraws draws{0.5, 0.5, std::vector<double>(heard.signal.packet->format.frame_bits.size(), 0.5)};
  const bool acquired = acquires(heard.signal, heard.others, draws, statistics);
  EXPECT_EQ(decide_reception(heard.signal, heard.others, draws, acquired, statistics),
            OutcomeKind::kReceived);
  EXPECT_EQ(statistics.reason, LossReason::kNone);
  EXPECT_GT(statistics.powers.noise, 0);
}

}  // namespace
}  // namespace halocline::channel_server
