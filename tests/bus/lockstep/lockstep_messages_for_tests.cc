// One valid message of each of lockstep's own types (messages_for_tests.h).
#include "tests/bus/messages_for_tests.h"

namespace halocline::bus::testing {
namespace {

int size_of_arrays(unsigned seed) { return static_cast<int>(seed * 5u % 23u); }

std::vector<std::uint8_t> bytes_of(unsigned seed) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size_of_arrays(seed)));
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i + seed);
  return bytes;
}

// One slice of three.
template <class Message>
void fill_slice(unsigned seed, Message& m) {
  m.slice_number = static_cast<std::int32_t>(seed % 3u);
  m.slice_count = 3;
  m.slice_bytes = bytes_of(seed);
  m.num_slice_bytes = static_cast<std::int32_t>(m.slice_bytes.size());
}

}  // namespace

template <>
lockstep_message_t valid_message(unsigned seed) {
  lockstep_message_t m{};
  m.instant_ns = 1000 + seed;
  m.channel_name = "STATE.auv-" + std::to_string(seed);
  m.message_bytes = bytes_of(seed);
  m.num_message_bytes = static_cast<std::int32_t>(m.message_bytes.size());
  return m;
}

namespace {
std::vector<lockstep_message_t> some_messages(unsigned seed) {
  std::vector<lockstep_message_t> messages;
  for (unsigned i = 0; i < seed % 4u; ++i) messages.push_back(valid_message<lockstep_message_t>(seed + i));
  return messages;
}
}  // namespace

template <>
lockstep_turn_t valid_message(unsigned seed) {
  lockstep_turn_t m{};
  m.instant_ns = 5000 + seed;
  m.horizon_ns = 6000 + seed;
  m.most_steps = static_cast<std::int32_t>(seed) - 1;
  m.farewell = seed % 2u;
  m.stopping_channels.assign(seed % 3u, "SEND\\..*");
  m.num_stopping = static_cast<std::int32_t>(m.stopping_channels.size());
  m.heard = some_messages(seed);
  m.num_heard = static_cast<std::int32_t>(m.heard.size());
  return m;
}

template <>
lockstep_result_t valid_message(unsigned seed) {
  lockstep_result_t m{};
  m.participant_name = "node-" + std::to_string(seed);
  m.num_steps = static_cast<std::int32_t>(seed);
  m.reached_ns = 7000 + seed;
  m.next_due_ns = 8000 + seed;
  m.said_digest = 9000 + seed;
  m.said = some_messages(seed + 1);
  m.num_said = static_cast<std::int32_t>(m.said.size());
  return m;
}

template <>
lockstep_grant_t valid_message(unsigned seed) {
  lockstep_grant_t m{};
  m.run_id = 10 + seed;
  m.num_addressed = static_cast<std::int32_t>(seed % 5u);
  for (std::int32_t i = 0; i < m.num_addressed; ++i) {
    m.addressed_lives.push_back(20 + i);
    m.first_turns.push_back(1 + i);
  }
  m.num_turns = 1;
  m.past = seed % 2u;
  fill_slice(seed, m);
  return m;
}

template <>
lockstep_answer_t valid_message(unsigned seed) {
  lockstep_answer_t m{};
  m.run_id = 10 + seed;
  m.answering_life = 20 + seed;
  m.turn_number = 1 + seed;
  m.wants_to_leave = seed % 2u;
  fill_slice(seed, m);
  return m;
}

template <>
lockstep_join_t valid_message(unsigned seed) {
  lockstep_join_t m{};
  m.run_id = seed;
  m.joining_life = 20 + seed;
  m.participant_name = "node-" + std::to_string(seed);
  m.scenario_digest = std::string(seed % 6u, 'd');
  m.step_stage = static_cast<std::int32_t>(seed % 7u);
  m.next_due_ns = 30 + seed;
  m.turns_taken = seed;
  m.wants_to_leave = seed % 2u;
  m.subscriptions.assign(seed % 4u, "STATE\\..*");
  m.only_stores.assign(seed % 4u, 1);
  m.num_subscriptions = static_cast<std::int32_t>(m.subscriptions.size());
  return m;
}

template <>
lockstep_notice_t valid_message(unsigned seed) {
  lockstep_notice_t m{};
  m.run_id = 10 + seed;
  m.noticed_life = 20 + seed;
  m.notice_kind = static_cast<std::int8_t>(seed % 3u);
  m.reason = std::string(seed % 6u, 'r');
  return m;
}

}  // namespace halocline::bus::testing
