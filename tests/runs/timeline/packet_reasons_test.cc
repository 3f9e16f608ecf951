// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/packet_reasons.h"

#include <set>

#include <gmock/gmock.h>

#include "runs/timeline/outcome_classes.h"
#include "runs/timeline/outcome_ledger.h"
#include "tests/runs/timeline/timeline_fixtures.h"

namespace halocline::clients {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using testing::outcome;
using ::testing::StartsWith;

std::string name(std::int32_t id) { return "auv-" + std::to_string(id); }

packet_outcome_t with_numbers(std::int8_t result) {
  packet_outcome_t o = outcome(1, 3, 12, 0, result);
  o.acquisition_probability = 0.9;
  o.acquisition_draw = 0.2;
  o.success_probability = 0.6;
  o.success_draw = result == packet_outcome_t::RECEIVED ? 0.5 : 0.7;
  o.sinr_db = 2.7;
  return o;
}

TEST(Sentence, EveryOutcomeHasOneOfItsOwnThatNamesTheReceiver) {
  std::set<std::string> sentences;
  for (std::size_t kind = 0; kind < kOutcomes; ++kind) {
    const std::string text = sentence(with_numbers(static_cast<std::int8_t>(kind)), name);
    EXPECT_THAT(text, StartsWith(kind == 0 ? "Received at auv-3: " : "Lost at auv-3: "))
        << outcome_name(kind);
    EXPECT_THAT(text, EndsWith(".")) << outcome_name(kind);
    EXPECT_GT(text.size(), 35u) << text;
    sentences.insert(text);
  }
  EXPECT_EQ(sentences.size(), kOutcomes);
}

TEST(Sentence, OwnEchoesAreDistinguishedFromNoiseAndFromOthers) {
  packet_outcome_t o = with_numbers(packet_outcome_t::BIT_ERRORS);
  EXPECT_THAT(sentence(o, name), HasSubstr("noise of 90.0 dB"));
  o.interference_level_db = 97;
  EXPECT_THAT(sentence(o, name), HasSubstr("noise of 90.0 dB"));  // interference alone is no late echo
  o.loss_reason = packet_outcome_t::REASON_LATE_ECHOES;
  o.late_echo_db = -3.2;
  EXPECT_THAT(sentence(o, name), HasSubstr("its own late echoes, 3.2 dB below its signal"));
  EXPECT_THAT(sentence(o, name), HasSubstr("SINR 2.7 dB; 60 % of such packets survive"));
  o.num_colliders = 1;
  o.colliders.push_back({2, 0, 7, 5, 0});
  o.loss_reason = packet_outcome_t::REASON_OTHER_PACKETS;
  EXPECT_THAT(sentence(o, name), HasSubstr("disturbed by auv-2:5"));
}

TEST(Sentence, LateEchoesAreSaidOfLateEchoesAlone) {
  packet_outcome_t o = with_numbers(packet_outcome_t::BIT_ERRORS);
  o.interference_level_db = 120;
  for (const std::int8_t reason :
       {packet_outcome_t::REASON_NONE, packet_outcome_t::REASON_NOISE, packet_outcome_t::REASON_FAST_FADING,
        packet_outcome_t::REASON_OTHER_PACKETS, packet_outcome_t::REASON_IMPULSES}) {
    o.loss_reason = reason;
    EXPECT_THAT(sentence(o, name), ::testing::Not(HasSubstr("echo")));
  }
}

TEST(Ladder, ALossHasTheFivePowersThatDisturbed) {
  packet_outcome_t o = with_numbers(packet_outcome_t::BIT_ERRORS);
  o.loss_reason = packet_outcome_t::REASON_LATE_ECHOES;
  o.noise_db = -12;
  o.late_echo_db = -3;
  o.fast_fading_db = o.interference_db = o.impulse_db = -300;
  std::vector<std::string> names;
  for (const LadderStep& step : ladder(o)) names.push_back(step.step);
  EXPECT_THAT(names, ::testing::IsSupersetOf({"noise_over_signal", "late_echoes"}));
  EXPECT_THAT(names, ::testing::Not(::testing::Contains("fast_fading")));
}

TEST(Sentence, ACollisionIsWithAPacketThatWasFollowedOrWithOneThatDisturbed) {
  packet_outcome_t o = with_numbers(packet_outcome_t::COLLIDED);
  o.num_colliders = 1;
  o.colliders.push_back({2, 0, 7, 5, 0});
  EXPECT_THAT(sentence(o, name), HasSubstr("disturbed by auv-2:5, without which"));
  o.success_probability = o.acquisition_probability = 0;
  EXPECT_THAT(sentence(o, name), HasSubstr("the receiver was following auv-2:5"));
}

TEST(Refusal, EveryRefusalHasASentence) {
  for (std::size_t result = 0; result < kReceiptResults; ++result) {
    const bool sent = result == modem_receipt_t::ACCEPTED || result == modem_receipt_t::QUEUED;
    EXPECT_EQ(refusal(static_cast<std::int8_t>(result)).empty(), sent) << receipt_name(result);
  }
}

std::vector<std::string> steps(const packet_outcome_t& o) {
  std::vector<std::string> names;
  for (const LadderStep& step : ladder(o)) {
    names.push_back(step.step);
    EXPECT_FALSE(step.help.empty()) << step.step;
  }
  return names;
}

TEST(Ladder, GoesFromTheTransmittedLevelToTheDraws) {
  packet_outcome_t o = with_numbers(packet_outcome_t::BIT_ERRORS);
  o.interference_level_db = 95;
  EXPECT_THAT(steps(o), ::testing::ElementsAre("paths", "source", "loss", "level", "noise", "snr",
                                               "interference", "sinr", "acquisition", "success", "outcome"));
  const auto rungs = ladder(o);
  EXPECT_EQ(rungs[1].value, 165);  // received 100 after a loss of 65
  EXPECT_EQ(rungs[3].limit, 80);
  EXPECT_EQ(rungs[3].passed, true);
  EXPECT_EQ(rungs[8].passed, true);
  EXPECT_EQ(rungs[9].passed, false);
  EXPECT_EQ(rungs[10].passed, false);
}

TEST(Ladder, EndsAtTheStepThatLostThePacket) {
  packet_outcome_t o = outcome(1, 3, 12, 0, packet_outcome_t::BELOW_CUTOFF);
  o.cutoff_level_db = 120;
  EXPECT_THAT(steps(o),
              ::testing::ElementsAre("paths", "source", "loss", "level", "noise", "snr", "outcome"));
  EXPECT_EQ(ladder(o)[3].passed, false);
  o = outcome(1, 3, 12, 0, packet_outcome_t::SHADOW);
  o.num_paths = 0;
  EXPECT_THAT(steps(o), ::testing::ElementsAre("paths", "outcome"));
  o = with_numbers(packet_outcome_t::NOT_ACQUIRED);
  o.success_probability = 0;
  o.acquisition_draw = 0.95;
  EXPECT_EQ(ladder(o).at(ladder(o).size() - 2).passed, false);
}

TEST(OutcomeClasses, AreSixWithAMarkAndAColourEachThatNoOtherHas) {
  std::set<std::string> keys, marks, colours;
  for (const OutcomeClass& c : outcome_classes()) {
    keys.insert(c.key);
    marks.insert(c.mark);
    colours.insert(c.colour);
  }
  EXPECT_EQ(keys.size(), kOutcomeClasses);
  EXPECT_EQ(marks.size(), kOutcomeClasses);
  EXPECT_EQ(colours.size(), kOutcomeClasses);
  for (std::size_t kind = 0; kind < kOutcomes; ++kind) {
    EXPECT_LT(class_of_outcome(kind), kOutcomeClasses);
    EXPECT_EQ(class_of_outcome(kind) == 0, kind == packet_outcome_t::RECEIVED) << outcome_name(kind);
  }
}

}  // namespace
}  // namespace halocline::clients
