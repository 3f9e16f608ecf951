// SPDX-License-Identifier: BSD-3-Clause
#include "bus/recovery/crash_journal.h"

namespace halocline::bus {
namespace {

using Kind = JournalledMessage::Kind;

constexpr std::size_t kOutputHeadBytes = 20;  // session, sequence, length of the identity

}  // namespace

Bytes CrashJournal::to_bytes(const Output& output) {
  Bytes bytes;
  append_int64(output.session, bytes);
  append_int64(output.sequence, bytes);
  append_uint32(static_cast<std::uint32_t>(output.identity.size()), bytes);
  bytes.insert(bytes.end(), output.identity.begin(), output.identity.end());
  bytes.insert(bytes.end(), output.message.begin(), output.message.end());
  return bytes;
}

std::optional<CrashJournal::Output> CrashJournal::to_output(const JournalledMessage& entry) {
  const Bytes& bytes = entry.bytes;
  if (bytes.size() < kOutputHeadBytes || uint32_at(bytes, 16) > bytes.size() - kOutputHeadBytes)
    return std::nullopt;
  const auto identity = bytes.begin() + kOutputHeadBytes, message = identity + uint32_at(bytes, 16);
  return Output{
      entry.channel, {identity, message}, int64_at(bytes, 0), int64_at(bytes, 8), {message, bytes.end()}};
}

void CrashJournal::open(Rule rule) {
  kept_ = rule.kept;
  journal_ = std::make_unique<MessageJournal>(
      MessageJournal::Rule{rule.path, rule.kept, rule.keep_last, rule.keep_all, rule.digest});
  if (const std::size_t bytes = journal_->bytes_damaged(); bytes > 0)
    bus_.log().warning("journal-damaged", "file=" + rule.path + " bytes_left_out=" + std::to_string(bytes));
  if (journal_->is_of_another_run())
    bus_.log().warning("journal-of-another-run",
                       "file=" + rule.path + " reason=\"another scenario, share or version\"");
  for (JournalledMessage& entry : journal_->take_inherited()) {
    last_step_ = entry.at;
    const bool is_output = entry.kind == Kind::kOutput;
    history_.push_back(is_output ? JournalledMessage{Kind::kOutput, entry.at, {}, {}} : entry);
    if (is_output) outputs_.push_back(std::move(entry));
  }
  bus_.set_tap([this, is_input = std::move(rule.is_input)](std::string_view channel, const void* data,
                                                           std::size_t size) {
    if (!replays_ && is_input(channel)) journal_->add_input(channel, data, size);
  });
}

void CrashJournal::replay_inputs(const std::function<void(SimTime at)>& end_step) {
  replays_ = true;
  const auto history = std::exchange(history_, {});
  for (std::size_t i = 0; i < history.size(); ++i) {
    const JournalledMessage& entry = history[i];
    if (entry.kind == Kind::kInput) bus_.deliver(entry.channel, entry.bytes);
    if (i + 1 < history.size() && history[i + 1].at == entry.at) continue;
    end_step(entry.at);
  }
  replays_ = false;
  if (!last_step_) return;
  bus_.continue_flows([this](std::string_view channel) { return journal_->keeps_last(channel); });
}

bool CrashJournal::resume(SimTime now) {
  const auto outputs = std::exchange(outputs_, {});
  if (!last_step_) return true;
  const std::string last = "last_t=" + std::to_string(last_step_->seconds());
  if (now < *last_step_ - kSameRun || now > *last_step_ + kept_) {
    bus_.log().info("journal-of-another-run", last);
    journal_->clear();
    bus_.forget_flows();
    return false;
  }
  bus_.log().info("resuming", last);
  for (const JournalledMessage& entry : outputs) {
    if (auto output = to_output(entry)) restore(std::move(*output));
  }
  published_forgotten_at_ = *last_step_ + kept_ * 2;
  recovers_ = true;
  return true;
}

void CrashJournal::restore(Output output) {
  publisher_.resume(output.channel, output.session, output.sequence);
  bus_.restore_history(output.channel, output.session, output.sequence, std::move(output.message));
  published_.emplace(std::move(output.channel), std::move(output.identity));
}

void CrashJournal::write_inputs(SimTime now) {
  step_ = now;
  if (!is_open()) return;
  journal_->write_inputs(now);
  if (journal_->is_given_up() && !std::exchange(given_up_, true))
    bus_.log().error(
        "journal-given-up",
        "reason=\"the disk refused it, or it was deleted or truncated; after a kill the node begins anew\"");
  if (now > published_forgotten_at_) published_.clear();
}

bool CrashJournal::claim(const std::string& channel, const std::string& identity) {
  if (was_published(channel, identity)) return false;
  if (recovers_) published_.emplace(channel, identity);
  return true;
}

void CrashJournal::clear() {
  if (is_open()) journal_->clear();
  published_.clear();
  recovers_ = false;
}

}  // namespace halocline::bus
