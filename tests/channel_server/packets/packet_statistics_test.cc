// SPDX-License-Identifier: BSD-3-Clause
// Long random runs through the medium: nothing is lost, nothing is counted twice, losses are as frequent as
// the model gives, and the order in which messages came does not matter.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/sim_time.h"
#include "tests/channel_server/packets/busy_sea.h"
#include "tests/support/doc_table.h"

namespace halocline::channel_server {
namespace {

using testing::BusyRun;
using testing::kBusyVehicles;
using testing::run_busy_sea;

// Builds without optimization run a tenth of it, in about the same time.
#ifdef NDEBUG
constexpr std::size_t kManyPackets = 100'000, kPacketsThatFade = 10'000;
#else
constexpr std::size_t kManyPackets = 10'000, kPacketsThatFade = 1000;
#endif

// Successes where each had a probability of its own.
struct Trials {
  double expected = 0, variance = 0;
  std::int64_t count = 0, successes = 0;

  void add(double probability, bool success) {
    expected += probability;
    variance += probability * (1 - probability);
    ++count;
    successes += success ? 1 : 0;
  }
  // Within the central 99.9 % of what the probabilities give: 3.29 standard deviations and half a count. Of
  // less than 10 in variance the normal approximation does not hold.
  bool says_anything() const { return variance >= 10; }
  bool agrees() const {
    return std::abs(static_cast<double>(successes) - expected) <= 3.29 * std::sqrt(variance) + 0.5;
  }
};

struct Tally {
  std::map<PacketName, std::uint32_t> receivers;  // bit id set: has ended there
  std::map<OutcomeKind, std::int64_t> outcomes;
  std::map<int, Trials> bits_by_sinr, preambles_by_snr;  // by whole dB
  std::map<SendResult, std::int64_t> receipts;
  std::int64_t accepted = 0, packet_outcomes = 0, twice = 0;

  void operator()(const MediumEvent& event) {
    if (const auto* receipt = std::get_if<Receipt>(&event.what)) {
      ++receipts[receipt->result];
      const bool sent = receipt->result == SendResult::kAccepted || receipt->result == SendResult::kQueued;
      accepted += sent ? 1 : 0;
      return;
    }
    const auto& end = std::get<PacketOutcome>(event.what);
    std::uint32_t& mask = receivers[end.packet->name()];
    const std::uint32_t bit = 1u << end.receiver_id;
    twice += (mask & bit) != 0 ? 1 : 0;
    mask |= bit;
    ++packet_outcomes;
    ++outcomes[end.kind];
    count_probabilities(end);
  }

  void count_probabilities(const PacketOutcome& end) {
    const DecisionStatistics& j = end.statistics;
    if (j.success_probability > 0) {  // acquired
      bits_by_sinr[static_cast<int>(std::floor(j.sinr.value))].add(j.success_probability,
                                                                   end.kind == OutcomeKind::kReceived);
    }
    // Alone at the receiver, what was acquired was received or has bit errors.
    if (j.acquisition_probability > 0 && j.colliders.empty()) {
      preambles_by_snr[static_cast<int>(std::floor(end.budget.snr.value))].add(
          j.acquisition_probability, end.kind != OutcomeKind::kNotAcquired);
    }
  }
};

void expect_one_end_at_every_possible_receiver(const Tally& tally, const VehicleRegistry& fleet) {
  EXPECT_EQ(tally.twice, 0);
  std::int64_t expected_outcomes = 0, requested = 0, answers = 0;
  for (const auto& [name, mask] : tally.receivers) {
    std::uint32_t expected = 0;
    for (const VehicleId id : fleet.present(name.departure)) expected |= 1u << id;
    expected &= ~(1u << name.source_id);
    EXPECT_EQ(mask, expected) << "packet " << name.packet_sequence << " of " << name.source_id;
    expected_outcomes += std::popcount(expected);
    ++(name.kind == PacketKind::kPingReply ? answers : requested);
  }
  EXPECT_EQ(tally.packet_outcomes, expected_outcomes);
  // Every accepted request became a packet; the others are answers to pings.
  EXPECT_EQ(requested, tally.accepted);
  EXPECT_GT(answers, 0);
}

void expect_counts_that_add_up(const Tally& tally, std::size_t packets) {
  std::int64_t receipts = 0, packet_outcomes = 0;
  for (const auto& [result, count] : tally.receipts) receipts += count;
  for (const auto& [kind, count] : tally.outcomes) packet_outcomes += count;
  EXPECT_EQ(receipts, static_cast<std::int64_t>(packets));
  EXPECT_EQ(packet_outcomes, tally.packet_outcomes);
}

// The run is worth something: whatever may happen does.
void expect_every_outcome_and_refusal(const Tally& tally) {
  for (int kind = 0; kind <= static_cast<int>(OutcomeKind::kForeign); ++kind) {
    const auto found = tally.outcomes.find(static_cast<OutcomeKind>(kind));
    EXPECT_GT(found == tally.outcomes.end() ? 0 : found->second, 30) << "outcome " << kind;
  }
  for (const auto result : {SendResult::kAccepted, SendResult::kBusy, SendResult::kQueued}) {
    EXPECT_TRUE(tally.receipts.contains(result)) << static_cast<int>(result);
  }
}

void expect_odds_kept(const std::string& what, const std::map<int, Trials>& bins, int min_bins) {
  int compared = 0;
  std::int64_t cases = 0;
  double farthest = 0;  // standard deviations
  for (const auto& [decibels, trials] : bins) {
    if (!trials.says_anything()) continue;
    ++compared;
    cases += trials.count;
    farthest = std::max(farthest, std::abs(static_cast<double>(trials.successes) - trials.expected) /
                                      std::sqrt(trials.variance));
    EXPECT_TRUE(trials.agrees()) << decibels << " dB: " << trials.successes << " of " << trials.count
                                 << ", expected " << trials.expected << " +- " << std::sqrt(trials.variance);
  }
  EXPECT_GE(compared, min_bins);
  halocline::testing::doc_row(
      "odds", {what, fmt::format("{}", compared), fmt::format("{}", cases), fmt::format("{:.1f}", farthest)});
}

// One run for all of it, because it takes a quarter of a minute.
TEST(PacketStatistics, OfAHundredThousandPacketsEachEndsOnceEverywhereWithTheOddsOfTheModel) {
  Tally tally;
  const VehicleRegistry fleet = run_busy_sea({.packets = kManyPackets}, tally);
  expect_one_end_at_every_possible_receiver(tally, fleet);
  expect_counts_that_add_up(tally, kManyPackets);
  expect_every_outcome_and_refusal(tally);
  expect_odds_kept("bits right, by SINR, no fading", tally.bits_by_sinr, 5);
  expect_odds_kept("preambles acquired, by SNR, no fading", tally.preambles_by_snr, 3);
}

TEST(PacketStatistics, OfTenThousandPacketsThatFadeEachEndsOnceEverywhereWithTheOddsOfTheModel) {
  Tally tally;
  const VehicleRegistry fleet = run_busy_sea({.packets = kPacketsThatFade, .fades = true}, tally);
  expect_one_end_at_every_possible_receiver(tally, fleet);
  expect_counts_that_add_up(tally, kPacketsThatFade);
  expect_odds_kept("bits right, by SINR", tally.bits_by_sinr, 5);
  expect_odds_kept("preambles acquired, by SNR", tally.preambles_by_snr, 3);
}

// FNV-1a over everything that an event holds.
class Hash {
 public:
  void operator()(const MediumEvent& event) {
    add(event.at.nanoseconds());
    if (const auto* receipt = std::get_if<Receipt>(&event.what)) {
      add(receipt->packet_sequence);
      add(static_cast<std::int64_t>(receipt->result));
      return add(receipt->start.nanoseconds());
    }
    const auto& end = std::get<PacketOutcome>(event.what);
    add(end.packet->name());
    add(end.receiver_id);
    add(static_cast<std::int64_t>(end.kind));
    for (const double value :
         {end.travel_time_s, end.two_way_travel_time_s, end.doppler_factor, end.budget.received_level.value,
          end.statistics.interference.value, end.statistics.sinr.value,
          end.statistics.acquisition_probability, end.statistics.success_probability,
          end.statistics.acquisition_draw, end.statistics.success_draw}) {
      add(std::bit_cast<std::int64_t>(value));
    }
    for (const PacketName& name : end.statistics.colliders) add(name);
  }
  std::uint64_t value() const { return hash_; }

 private:
  void add(const PacketName& name) {
    add(name.source_id);
    add(name.packet_sequence);
    add(name.departure.nanoseconds());
  }
  void add(std::int64_t number) {
    for (int byte = 0; byte < 8; ++byte) {
      hash_ = (hash_ ^ (static_cast<std::uint64_t>(number) >> (8 * byte) & 0xff)) * 0x100000001b3u;
    }
  }
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

std::uint64_t hash_of(const BusyRun& run) {
  Hash hash;
  run_busy_sea(run, hash);
  return hash.value();
}

TEST(PacketRepeatability, TheOrderOfArrivalChangesNothing) {
  for (const bool fades : {false, true}) {
    const std::size_t packets = fades ? 300 : 1500;
    const std::uint64_t expected = hash_of({.packets = packets, .fades = fades});
    for (std::uint32_t turn = 1; turn <= 3; ++turn) {
      EXPECT_EQ(hash_of({.packets = packets, .turn = turn, .fades = fades}), expected);
    }
  }
}

TEST(PacketRepeatability, TheLengthOfTheStepsChangesNothing) {
  EXPECT_EQ(hash_of({.packets = 500, .step_s = 0.01}), hash_of({.packets = 500, .step_s = 7}));
}

TEST(PacketRepeatability, AnotherSeedIsAnotherRun) {
  EXPECT_NE(hash_of({.packets = 500, .seed = 1}), hash_of({.packets = 500, .seed = 2}));
}

// The same in every build on one platform; changes only with a line in the changelog.
TEST(PacketRepeatability, TheRunIsTheOneOnRecord) {
  EXPECT_EQ(hash_of({.packets = 2000}), 6852104253157696703u);
}

TEST(PacketRepeatability, EventsComeInTheOrderOfTheirInstants) {
  std::vector<SimTime> instants;
  run_busy_sea({.packets = 500}, [&](const MediumEvent& event) { instants.push_back(event.at); });
  EXPECT_TRUE(std::is_sorted(instants.begin(), instants.end()));
}

}  // namespace
}  // namespace halocline::channel_server
