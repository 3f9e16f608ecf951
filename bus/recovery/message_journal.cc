// SPDX-License-Identifier: BSD-3-Clause
#include "bus/recovery/message_journal.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>

#include "bus/messages/message_codec.h"
#include "bus/messages/sequence_number.h"
#include "core/limits.h"

namespace halocline::bus {
namespace {

using Kind = JournalledMessage::Kind;

constexpr std::string_view kHeader = "HALOCLINE INPUT2";
constexpr std::size_t kMaxKept = 1000;                  // inputs of keep_all
constexpr std::size_t kMaxKeptLast = 4 * kMaxVehicles;  // channels of keep_last
constexpr std::size_t kMaxSessions = 8;                 // sessions of each channel
constexpr std::size_t kHeadBytes = 9;                   // head of a body: time stamp, length of the channel
// Limit on the time of a step, before or after the start (146 years), so that sums and differences of times
// do not overflow.
constexpr std::int64_t kStepNs = std::numeric_limits<std::int64_t>::max() / 2;

// Layout of a body: time stamp, length of the channel, channel, message.
JournalFile::Record to_record(const JournalledMessage& entry) {
  Bytes body;
  append_int64(entry.at.nanoseconds(), body);
  body.push_back(static_cast<std::uint8_t>(entry.channel.size()));  // at most 63 in LCM
  body.insert(body.end(), entry.channel.begin(), entry.channel.end());
  body.insert(body.end(), entry.bytes.begin(), entry.bytes.end());
  return {static_cast<std::uint8_t>(entry.kind), std::move(body)};
}

std::optional<JournalledMessage> to_entry(const JournalFile::Record& record) {
  const Bytes& body = record.body;
  if (record.kind > static_cast<std::uint8_t>(Kind::kDigest) || body.size() < kHeadBytes) return std::nullopt;
  const std::size_t channel_bytes = body[kHeadBytes - 1];
  if (channel_bytes > body.size() - kHeadBytes) return std::nullopt;
  JournalledMessage entry;
  entry.kind = static_cast<Kind>(record.kind);
  const std::int64_t at_ns = int64_at(body, 0);
  if (entry.kind != Kind::kDigest && (at_ns <= -kStepNs || at_ns >= kStepNs)) return std::nullopt;
  entry.at = SimTime::from_nanoseconds(at_ns);
  const auto channel = body.begin() + kHeadBytes,
             message = channel + static_cast<std::ptrdiff_t>(channel_bytes);
  entry.channel.assign(channel, message);
  entry.bytes.assign(message, body.end());
  return entry;
}

// Returns the publisher's session; 0 if none is stated.
std::int64_t session_of(const JournalledMessage& input) {
  return input.bytes.size() < kFlowHeadBytes ? 0 : int64_at(input.bytes, kSessionAt);
}

}  // namespace

void MessageJournal::read(JournalFile& file) {
  const JournalFile::Contents contents = file.read();
  bytes_damaged_ += contents.bytes_damaged + contents.bytes_cut;
  std::uint64_t digest = 0;
  for (const JournalFile::Record& record : contents.records) {
    auto entry = to_entry(record);
    if (!entry) {
      bytes_damaged_ += record.body.size();
    } else if (entry->kind == Kind::kDigest) {
      digest = static_cast<std::uint64_t>(entry->at.nanoseconds());
    } else if (digest == rule_.digest) {
      inherited_.push_back(std::move(*entry));
    } else {
      is_of_another_run_ = true;
    }
  }
}

MessageJournal::MessageJournal(Rule rule) : rule_(std::move(rule)) {
  file_ = std::make_unique<JournalFile>(rule_.path, kHeader);
  rule_.path = std::filesystem::canonical(rule_.path);  // if it is a link, its target is renamed
  if (std::filesystem::exists(rule_.path + ".1")) {
    JournalFile before(rule_.path + ".1", kHeader);
    read(before);
  }
  read(*file_);
  const auto earlier = [](const auto& a, const auto& b) { return a.at < b.at; };
  std::stable_sort(inherited_.begin(), inherited_.end(), earlier);
  for (const JournalledMessage& entry : inherited_) carry(entry);
  const SimTime oldest = inherited_.empty() ? SimTime() : inherited_.back().at - rule_.kept;
  std::erase_if(inherited_, [&](const JournalledMessage& entry) { return entry.at < oldest; });
  std::vector<JournalledMessage> older = carried();
  std::erase_if(older, [&](const JournalledMessage& entry) { return entry.at >= oldest; });
  inherited_.insert(inherited_.begin(), older.begin(), older.end());
  std::stable_sort(inherited_.begin(), inherited_.end(), earlier);
  begin_file(inherited_);
}

void MessageJournal::add_input(std::string_view channel, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  inputs_.push_back({Kind::kInput, {}, std::string(channel), {bytes, bytes + size}});
}

void MessageJournal::write_inputs(SimTime now) {
  if (inputs_.empty()) {
    idle_step_ = now;
    return;
  }
  if (const auto idle = std::exchange(idle_step_, std::nullopt)) write({{Kind::kStep, *idle, {}, {}}});
  for (JournalledMessage& entry : inputs_) {
    entry.at = now;
    carry(entry);
  }
  write(std::exchange(inputs_, {}));
}

void MessageJournal::write_output(SimTime now, std::string_view channel, std::vector<std::uint8_t> bytes) {
  write({{Kind::kOutput, now, std::string(channel), std::move(bytes)}});
}

void MessageJournal::clear() {
  idle_step_.reset();
  kept_last_.clear();
  kept_all_.clear();
  std::remove((rule_.path + ".1").c_str());
  begin_file({});
}

// The new file is written beside the old one and then renamed, so that a kill meanwhile leaves the old one.
void MessageJournal::begin_file(const std::vector<JournalledMessage>& entries) {
  const std::string unfinished = rule_.path + ".unfinished";
  std::remove(unfinished.c_str());
  file_ = std::make_unique<JournalFile>(unfinished, kHeader);
  file_begins_ = SimTime::never();
  const auto digest = SimTime::from_nanoseconds(static_cast<std::int64_t>(rule_.digest));
  const JournalFile::Record head = to_record({Kind::kDigest, digest, {}, {}});
  if (!file_->append({&head, 1})) return give_up();
  write(entries);
  if (file_ && std::rename(unfinished.c_str(), rule_.path.c_str()) != 0) give_up();
}

void MessageJournal::write(const std::vector<JournalledMessage>& entries) {
  if (entries.empty() || !file_) return;
  try {
    if (file_begins_ != SimTime::never() && entries.back().at - file_begins_ > rule_.kept) {
      std::rename(rule_.path.c_str(), (rule_.path + ".1").c_str());
      begin_file(carried());
      file_begins_ = entries.back().at;
    }
    if (file_begins_ == SimTime::never()) file_begins_ = entries.back().at;
    std::vector<JournalFile::Record> records;
    for (const JournalledMessage& entry : entries) records.push_back(to_record(entry));
    if (file_ && !file_->append(records)) give_up();
  } catch (const std::exception&) {
    give_up();
  }
}

// A journal that lacks entries would let the next incarnation contradict the messages of this one.
void MessageJournal::give_up() {
  file_.reset();
  for (const char* part : {"", ".1", ".unfinished"}) std::remove((rule_.path + part).c_str());
}

bool MessageJournal::keeps_last(std::string_view channel) const {
  return std::any_of(rule_.keep_last.begin(), rule_.keep_last.end(),
                     [&](const Family& family) { return channel.starts_with(family.prefix); });
}

void MessageJournal::carry(const JournalledMessage& entry) {
  if (entry.kind != Kind::kInput) return;
  if (keeps_last(entry.channel)) {
    std::vector<JournalledMessage>& of_channel = kept_last_[entry.channel];
    std::erase_if(of_channel, [&](const auto& other) { return session_of(other) == session_of(entry); });
    if (of_channel.size() == kMaxSessions) of_channel.erase(of_channel.begin());
    of_channel.push_back(entry);
  }
  if (kept_last_.size() > kMaxKeptLast) forget_older_half();
  // Each file begins with these inputs, so that the earlier incarnation's are read more than once.
  const auto is_known = [&](const JournalledMessage& other) {
    return other.at == entry.at && other.channel == entry.channel && other.bytes == entry.bytes;
  };
  for (const std::string& channel : rule_.keep_all) {
    if (entry.channel == channel && std::none_of(kept_all_.begin(), kept_all_.end(), is_known))
      kept_all_.push_back(entry);
  }
  if (kept_all_.size() > kMaxKept) kept_all_.pop_front();
}

// Dropping half of the channels at once keeps the cost per message constant, even for an endless series of
// names.
void MessageJournal::forget_older_half() {
  std::vector<SimTime> times;
  for (const auto& [channel, entries] : kept_last_) times.push_back(entries.back().at);
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  // Limits the number dropped, as all may be of one instant.
  std::size_t left = times.size() / 2;
  std::erase_if(kept_last_,
                [&](const auto& kept) { return kept.second.back().at <= *middle && left > 0 && left-- > 0; });
}

std::vector<JournalledMessage> MessageJournal::carried() const {
  std::vector<JournalledMessage> entries(kept_all_.begin(), kept_all_.end());
  for (const auto& [channel, of_channel] : kept_last_)
    entries.insert(entries.end(), of_channel.begin(), of_channel.end());
  return entries;
}

}  // namespace halocline::bus
