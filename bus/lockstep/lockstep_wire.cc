#include "bus/lockstep/lockstep_wire.h"

#include <algorithm>

#include "core/hash.h"
#include "core/names.h"

namespace halocline::bus {
namespace {

constexpr int kMaxSlices = 10'000;  // half a gigabyte; a body that says more is corrupt

std::string problem_in_slices(int number, int count) {
  if (count < 1 || count > kMaxSlices) return "slice_count is impossible";
  return number >= 0 && number < count ? "" : "slice_number is impossible";
}

}  // namespace

std::string problem_in(const lockstep_message_t& m) {
  return m.channel_name.empty() || m.channel_name.size() > 63 ? "channel_name is no channel of LCM's" : "";
}

std::string problem_in(const lockstep_turn_t& m) {
  if (m.most_steps < -1) return "most_steps is below -1";
  for (const lockstep_message_t& heard : m.heard) {
    if (std::string problem = problem_in(heard); !problem.empty()) return problem;
  }
  return "";
}

std::string problem_in(const lockstep_result_t& m) {
  if (!is_valid_name(m.participant_name)) return "participant_name is no name";
  for (const lockstep_message_t& said : m.said) {
    if (std::string problem = problem_in(said); !problem.empty()) return problem;
  }
  return m.num_steps < -1 ? "num_steps is below -1" : "";
}

std::string problem_in(const lockstep_grant_t& m) {
  if (m.num_turns < 1) return "num_turns is below 1";
  const bool sound = std::all_of(m.first_turns.begin(), m.first_turns.end(), [](auto n) { return n >= 1; });
  return sound ? problem_in_slices(m.slice_number, m.slice_count) : "first_turns is below 1";
}

std::string problem_in(const lockstep_answer_t& m) {
  return m.turn_number < 1 ? "turn_number is below 1" : problem_in_slices(m.slice_number, m.slice_count);
}

std::string problem_in(const lockstep_join_t& m) {
  if (!is_valid_name(m.participant_name)) return "participant_name is no name";
  if (m.joining_life == 0) return "joining_life is 0";
  return m.turns_taken < 0 ? "turns_taken is below 0" : "";
}

std::string problem_in(const lockstep_notice_t& m) {
  const bool known = m.notice_kind >= lockstep_notice_t::WELCOME && m.notice_kind <= lockstep_notice_t::OVER;
  return known ? "" : "notice_kind is no value of its enumeration";
}

int slice_count(std::size_t body_bytes) {
  return static_cast<int>(std::max<std::size_t>(1, (body_bytes + kMaxSliceBytes - 1) / kMaxSliceBytes));
}

std::span<const std::uint8_t> slice_of(const Bytes& body, int number) {
  const std::size_t start = static_cast<std::size_t>(number) * kMaxSliceBytes;
  return std::span(body).subspan(start, std::min(kMaxSliceBytes, body.size() - start));
}

std::optional<Bytes> SliceCollector::add(std::int64_t key, int number, int count, const Bytes& slice) {
  if (key != key_ || slices_.size() != static_cast<std::size_t>(count)) {
    key_ = key;
    slices_.assign(static_cast<std::size_t>(count), std::nullopt);
  }
  slices_[static_cast<std::size_t>(number)] = slice;
  Bytes body;
  for (const auto& part : slices_) {
    if (!part) return std::nullopt;
    body.insert(body.end(), part->begin(), part->end());
  }
  key_ = -1;
  slices_.clear();
  return body;
}

std::int64_t digest_of(std::int64_t before, std::span<const lockstep_message_t> said) {
  auto sum = static_cast<std::uint64_t>(before) ^ kFnvStart;
  for (const lockstep_message_t& message : said) sum = fnv1a(encoded(message), sum);
  return static_cast<std::int64_t>(sum ^ kFnvStart);
}

}  // namespace halocline::bus
