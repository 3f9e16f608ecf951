#include "bus/runtime/message_journal.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "core/atomic_file.h"
#include "core/check.h"

namespace halocline::bus {
namespace {

using Kind = JournalledMessage::Kind;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kEntryWord = 0x484c4d31;  // "HLM1"
constexpr std::size_t kHeadBytes = 25;            // word, kind, stamp, two lengths, check sum
constexpr std::size_t kMaxKept = 1000;            // of keep_all
constexpr std::size_t kMaxKeptLast = 16'384;      // channels of keep_last

void put(std::uint64_t value, int bytes, Bytes& to) {
  for (int shift = 8 * bytes - 8; shift >= 0; shift -= 8)
    to.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint64_t get(const std::uint8_t* at, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | at[i];
  return value;
}

// FNV-1a, 32 bits.
std::uint32_t check_sum(const std::uint8_t* at, std::size_t size) {
  std::uint32_t sum = 0x811c9dc5u;
  for (std::size_t i = 0; i < size; ++i) sum = (sum ^ at[i]) * 0x01000193u;
  return sum;
}

void append(const JournalledMessage& entry, Bytes& to) {
  Bytes body(entry.channel.begin(), entry.channel.end());
  body.insert(body.end(), entry.bytes.begin(), entry.bytes.end());
  put(kEntryWord, 4, to);
  put(static_cast<std::uint64_t>(entry.kind), 1, to);
  put(static_cast<std::uint64_t>(entry.at.nanoseconds()), 8, to);
  put(entry.channel.size(), 4, to);
  put(entry.bytes.size(), 4, to);
  put(check_sum(body.data(), body.size()), 4, to);
  to.insert(to.end(), body.begin(), body.end());
}

// The entry at `at`, which then points behind it; empty where no whole one is.
std::optional<JournalledMessage> take_entry(const Bytes& file, std::size_t& at) {
  if (file.size() - at < kHeadBytes || get(&file[at], 4) != kEntryWord) return std::nullopt;
  const std::size_t channel = get(&file[at + 13], 4), size = channel + get(&file[at + 17], 4);
  if (file.size() - at - kHeadBytes < size) return std::nullopt;
  const std::uint8_t* body = file.data() + at + kHeadBytes;
  if (check_sum(body, size) != get(&file[at + 21], 4)) return std::nullopt;
  JournalledMessage entry;
  entry.kind = static_cast<JournalledMessage::Kind>(file[at + 4]);
  entry.at = SimTime::from_nanoseconds(static_cast<std::int64_t>(get(&file[at + 5], 8)));
  entry.channel.assign(body, body + channel);
  entry.bytes.assign(body + channel, body + size);
  at += kHeadBytes + size;
  return entry;
}

void read(const std::string& path, std::vector<JournalledMessage>& entries) {
  std::ifstream in(path, std::ios::binary);
  const Bytes file{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  std::size_t at = 0;
  while (auto entry = take_entry(file, at)) entries.push_back(std::move(*entry));
}

}  // namespace

MessageJournal::MessageJournal(Rule rule) : rule_(std::move(rule)) {
  read(rule_.path + ".1", inherited_);
  read(rule_.path, inherited_);
  const auto earlier = [](const auto& a, const auto& b) { return a.at < b.at; };
  std::stable_sort(inherited_.begin(), inherited_.end(), earlier);
  for (const JournalledMessage& entry : inherited_) carry(entry);
  const SimTime horizon = inherited_.empty() ? SimTime() : inherited_.back().at - rule_.kept;
  std::erase_if(inherited_, [&](const JournalledMessage& entry) { return entry.at < horizon; });
  std::vector<JournalledMessage> older = carried();
  std::erase_if(older, [&](const JournalledMessage& entry) { return entry.at >= horizon; });
  inherited_.insert(inherited_.begin(), older.begin(), older.end());
  std::stable_sort(inherited_.begin(), inherited_.end(), earlier);
  begin_file(inherited_);
}

MessageJournal::~MessageJournal() { close(file_); }

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

// Written beside the old file first, so that a crash meanwhile leaves that.
void MessageJournal::begin_file(const std::vector<JournalledMessage>& entries) {
  if (file_ >= 0) close(file_);
  AtomicFile replacement(rule_.path);
  file_ =
      open(replacement.temporary_path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
  require(file_ >= 0, "cannot write the journal " + rule_.path + ": " + std::strerror(errno));
  file_begins_ = SimTime::never();
  write(entries);
  replacement.commit();
}

void MessageJournal::write(const std::vector<JournalledMessage>& entries) {
  if (entries.empty()) return;
  if (file_begins_ != SimTime::never() && entries.back().at - file_begins_ > rule_.kept) {
    std::rename(rule_.path.c_str(), (rule_.path + ".1").c_str());
    begin_file(carried());
    file_begins_ = entries.back().at;
  }
  if (file_begins_ == SimTime::never()) file_begins_ = entries.back().at;
  Bytes bytes;
  for (const JournalledMessage& entry : entries) append(entry, bytes);
  if (::write(file_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("the journal " + rule_.path + " could not be written whole (disk full?)");
}

void MessageJournal::carry(const JournalledMessage& entry) {
  if (entry.kind != Kind::kInput) return;
  for (const Family& family : rule_.keep_last) {
    if (entry.channel.starts_with(family.prefix)) kept_last_[entry.channel] = entry;
  }
  if (kept_last_.size() > kMaxKeptLast) forget_older_half();
  // Each file begins with them, so those of the earlier incarnation are read more than once.
  const auto is_known = [&](const JournalledMessage& other) {
    return other.at == entry.at && other.channel == entry.channel && other.bytes == entry.bytes;
  };
  for (const std::string& channel : rule_.keep_all) {
    if (entry.channel == channel && std::none_of(kept_all_.begin(), kept_all_.end(), is_known))
      kept_all_.push_back(entry);
  }
  if (kept_all_.size() > kMaxKept) kept_all_.pop_front();
}

// By halves, so that names made up without end cost no more than a constant for each.
void MessageJournal::forget_older_half() {
  std::vector<SimTime> times;
  for (const auto& [channel, entry] : kept_last_) times.push_back(entry.at);
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  // Not all, where all are of one instant.
  std::size_t left = times.size() / 2;
  std::erase_if(kept_last_,
                [&](const auto& kept) { return kept.second.at <= *middle && left > 0 && left-- > 0; });
}

std::vector<JournalledMessage> MessageJournal::carried() const {
  std::vector<JournalledMessage> entries(kept_all_.begin(), kept_all_.end());
  for (const auto& [channel, entry] : kept_last_) entries.push_back(entry);
  return entries;
}

}  // namespace halocline::bus
