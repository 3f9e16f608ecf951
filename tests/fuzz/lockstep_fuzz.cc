// SPDX-License-Identifier: BSD-3-Clause
// A lockstep run of a conductor and two participants that say anything: joins, answers, grants and notices as
// bytes, and results that fit the turn that was granted but for what the fuzzer puts in. What breaks the
// promises of lockstep may end the run (std::runtime_error).
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bus/lockstep/journal.h"
#include "bus/lockstep/lockstep_conductor.h"
#include "bus/lockstep/lockstep_participant.h"
#include "bus/lockstep/lockstep_wire.h"
#include "bus/messages/message_codec.h"
#include "core/sim_time.h"
#include "tests/fuzz/bus_message.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace halocline;

constexpr std::int64_t kRun = 1, kParticipant = 30;

template <class Message>
std::optional<Message> message_from(fuzz::Input& input) {
  return bus::decoded<Message>(fuzz::with_fingerprint(Message::getHash(), input.block()));
}

// As the bus delivers it; none where a receiver would refuse it.
template <class Message>
std::optional<Message> over_the_bus(const Message& message) {
  return bus::decoded<Message>(bus::encoded(message));
}

// Of a turn's instant: often near, now and then anything.
std::int64_t instant_from(fuzz::Input& input, std::int64_t from) {
  const auto near = input.number();
  return near == 0xff ? input.number<std::int64_t>() : from + 1'000'000 * std::int64_t{near};
}

class Run {
 public:
  Run()
      : conductor_({.expected = {"a", "b"},
                    .end = SimTime::from_seconds(2),
                    .drop_after = SimDuration::from_milliseconds(900)},
                   kRun,
                   {.grant = [this](const std::string&, const lockstep_grant_t& grant) { note(grant); },
                    .notice = [this](const lockstep_notice_t& m) { participant_.on_notice(m, steady_); },
                    .record = [](const conductor::JournalEntry&) {},
                    .publish = [](const lockstep_message_t&) {},
                    .report = [](const std::string&, const std::string&) {}}),
        participant_(introduction("a", kParticipant),
                     [](const lockstep_turn_t& turn) {
                       lockstep_result_t result{};
                       result.participant_name = "a";
                       result.reached_ns = result.next_due_ns = turn.instant_ns;
                       return result;
                     },
                     {[](const lockstep_join_t&) {}, [](const lockstep_answer_t&) {}}) {
    conductor_.start();
  }

  void step(fuzz::Input& input) {
    switch (input.below(11)) {
      case 0:
        if (const auto join = message_from<lockstep_join_t>(input)) conductor_.on_join(*join, steady_);
        break;
      case 1:
        if (const auto answer = message_from<lockstep_answer_t>(input))
          conductor_.on_answer(*answer, steady_);
        break;
      case 2:
        if (auto message = message_from<lockstep_message_t>(input)) conductor_.inject(std::move(*message));
        break;
      case 3:
        steady_ = steady_ + SimDuration::from_milliseconds(input.number());
        conductor_.on_timer(steady_);
        break;
      case 4:
        answer(input);
        break;
      case 5:
        if (const auto grant = message_from<lockstep_grant_t>(input)) participant_.on_grant(*grant, steady_);
        break;
      case 6:
        if (const auto notice = message_from<lockstep_notice_t>(input))
          participant_.on_notice(*notice, steady_);
        break;
      case 7:
        participant_.on_timer(steady_);
        break;
      case 8:
        input.below(2) == 0 ? conductor_.request_stop() : participant_.request_leave();
        break;
      case 9:
        join(input);
        break;
      default:
        for (const auto& [incarnation, grant] : grants_) participant_.on_grant(grant, steady_);
    }
  }

 private:
  static lockstep_join_t introduction(const std::string& name, std::int64_t incarnation) {
    lockstep_join_t join{};
    join.participant_name = name;
    join.incarnation = incarnation;
    return join;
  }
  static std::string name_of(std::int64_t incarnation) { return incarnation % 2 == 0 ? "a" : "b"; }

  void note(const lockstep_grant_t& grant) {
    for (const std::int64_t incarnation : grant.incarnations) grants_[incarnation] = grant;
  }

  void join(fuzz::Input& input) {
    const std::int64_t incarnation = 1 + input.number();
    lockstep_join_t join = introduction(name_of(incarnation), incarnation);
    join.step_stage = static_cast<std::int32_t>(input.below(7));
    join.next_due_ns = instant_from(input, 0);
    join.turns_taken = input.number();
    const std::size_t subscriptions = input.below(4);
    for (std::size_t i = 0; i < subscriptions; ++i) {
      join.subscriptions.emplace_back(input.text_block());
      join.only_stores.push_back(static_cast<std::int8_t>(input.below(2)));
    }
    join.num_subscriptions = static_cast<std::int32_t>(subscriptions);
    if (const auto received = over_the_bus(join)) conductor_.on_join(*received, steady_);
  }

  // To the latest grant of one incarnation.
  void answer(fuzz::Input& input) {
    if (grants_.empty()) return;
    const auto granted =
        std::next(grants_.begin(), static_cast<std::ptrdiff_t>(input.below(grants_.size() % 256)));
    const lockstep_grant_t& grant = granted->second;
    const auto me = std::find(grant.incarnations.begin(), grant.incarnations.end(), granted->first);
    const auto turns = bus::decoded_list<lockstep_turn_t>(grant.slice_bytes);
    const std::int64_t instant = turns && !turns->empty() ? turns->back().instant_ns : 0;
    lockstep_result_t result{};
    result.participant_name = name_of(granted->first);
    result.num_steps = static_cast<std::int8_t>(input.number());
    result.reached_ns = instant_from(input, instant);
    result.next_due_ns = instant_from(input, instant);
    result.lookahead_ns = instant_from(input, instant);
    const std::size_t outputs = input.below(4);
    for (std::size_t i = 0; i < outputs; ++i) {
      lockstep_message_t message{};
      message.instant_ns = instant_from(input, instant);
      message.channel_name = input.text_block();
      result.outputs.push_back(message);
    }
    result.num_outputs = static_cast<std::int32_t>(outputs);
    const bus::Bytes body = bus::encoded(result);
    lockstep_answer_t answer{};
    answer.run_id = kRun;
    answer.incarnation = granted->first;
    answer.turn_number =
        grant.first_turns[static_cast<std::size_t>(me - grant.incarnations.begin())] + grant.num_turns - 1;
    answer.slice_count = 1;
    answer.slice_bytes = body;
    answer.num_slice_bytes = static_cast<std::int32_t>(body.size());
    if (const auto received = over_the_bus(answer)) conductor_.on_answer(*received, steady_);
  }

  SimTime steady_;
  std::map<std::int64_t, lockstep_grant_t> grants_;  // the latest, by incarnation
  conductor::LockstepConductor conductor_;
  bus::LockstepParticipant participant_;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  Run run;
  try {
    while (!input.is_empty()) run.step(input);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
