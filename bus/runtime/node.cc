// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/node.h"

#include <tuple>

#include "bus/recovery/crash_journal.h"
#include "bus/repair/flow_history.h"
#include "bus/repair/flow_repair.h"
#include "bus/version.h"
#include "core/check.h"

namespace halocline::bus {
namespace {
constexpr SimDuration kStatusPeriod = SimDuration::from_milliseconds(1000);
constexpr SimDuration kLatenessReported = SimDuration::from_milliseconds(60'000);

// A published message: channel, session and sequence of its flow, bytes.
using Published = std::tuple<std::string, std::int64_t, std::int64_t, Bytes>;
}  // namespace

const Due& Node::known_due() const {
  if (!known_due_ || wakeups_at_due_ != bus_.counters().wakeups) {
    known_due_ = on_due();
    wakeups_at_due_ = bus_.counters().wakeups;
  }
  return *known_due_;
}

Due Node::due() const {
  Due due = known_due();
  due.steady = std::min({due.steady, next_status_, bus_.next_repair()});
  return due;
}

SimTime Node::lockstep_due() const {
  const Due both = due();
  return std::min(both.sim, both.steady);
}

SimTime Node::lookahead(const ChannelTest& matters) const {
  SimTime lookahead = on_lookahead(matters);
  if (matters(channels::kStatus.of(name()))) lookahead = std::min(lookahead, next_status_);
  return std::max(lookahead, lockstep_due());
}

void Node::step(const Now& now) {
  bus_.log().set_time(now.sim);
  bus_.rethrow_if_failed();
  if (resumed_from_ && now.sim_known) check_run(now);
  const Due due = known_due();
  known_due_.reset();
  commit(now, [&] {
    if (now.sim_known || due.sim == SimTime::at_once() || due.steady <= now.steady) on_step(now);
    if (now.steady >= next_status_) {
      publish_status(now, status_text());
      next_status_ = next_on_grid(now.steady, kStatusPeriod);
    }
  });
  bus_.repair(now.sim, now.steady, !is_behind_);
}

void Node::keep_state_in(std::unique_ptr<StateJournal> journal) {
  journal_ = std::move(journal);
  if (journal_->is_damaged())
    bus_.log().warning("journal-damaged", "reason=\"no whole record, or of another configuration\"");
  if (journal_->inherited()) load(*journal_->inherited());
}

void Node::restore_published(std::span<const std::uint8_t> messages) {
  for (Archive a(messages); !a.is_at_end();) {
    Published message;
    a(message);
    auto& [channel, session, sequence, bytes] = message;
    bus_.restore_history(channel, session, sequence, std::move(bytes));
  }
}

void Node::load(const StateJournal::Saved& saved) {
  require(saved.session == bus_.identity().session, "the journal is of another session");
  restore_published(saved.additions);
  Archive a(saved.state, saved.parts);
  a(status_sequence_);
  on_archive(a);
  known_due_.reset();
  a.require_end();
  resumed_from_ = saved.at;
}

void Node::check_run(const Now& now) {
  const SimTime from = *std::exchange(resumed_from_, std::nullopt);
  if (now.sim < from - kSameRun) return restart(now);
  bus_.log().info("resumed", "from_t=" + std::to_string(from.seconds()));
}

// Publishes the messages of `publish_all` after the state that results from it is on disk.
void Node::commit(const Now& now, const std::function<void()>& publish_all) {
  publish_after_journal(now, publish_all);
  on_committed();
}

void Node::publish_after_journal(const Now& now, const std::function<void()>& publish_all) {
  if (!journal_) return publish_all();
  if (!now.sim_known) {
    publish_all();
    if (on_wants_commit()) write_journal(resumed_from_.value_or(SimTime()));
    return;
  }
  std::vector<std::pair<std::string, Bytes>> outputs;
  auto outbox = bus_.set_outbox([&outputs](std::string_view channel, const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    outputs.emplace_back(channel, Bytes(bytes, bytes + size));
  });
  publish_all();
  bus_.set_outbox(std::move(outbox));
  const bool has_more = on_wants_commit();
  if (outputs.empty() && !has_more) return;
  write_journal(now.sim);
  bus_.counters().sent -= static_cast<std::int64_t>(outputs.size());  // were counted when collected
  for (const auto& [channel, bytes] : outputs) bus_.publish_bytes(channel, bytes.data(), bytes.size());
}

// The last message of each flow must stay available for repair; a record holds those of all flows that
// changed since the previous record.
void Node::write_journal(SimTime now) {
  const bool is_whole = journal_->wants_whole();
  Archive published;
  if (const FlowRepair* repair = bus_.flow_repair()) {
    const FlowHistory& history = repair->history();
    for (const auto& [flow, message] : history.last_messages(is_whole ? 0 : published_saved_)) {
      Published one(flow->channel, flow->session, flow->last, *message);
      published(one);
    }
    published_saved_ = history.published();
  }
  saved_.begin_with_parts(is_whole);
  saved_(status_sequence_);
  on_archive(saved_);
  const bool written = journal_->write(bus_.identity().session, now, saved_, published.bytes());
  if (written == has_journal_) return;
  has_journal_ = written;
  if (written) {
    bus_.log().info("journal-resumed");
  } else {
    bus_.log().error("journal-refused",
                     "reason=\"the disk refused it, or it was deleted or truncated; after a kill the node "
                     "starts from the beginning\"");
  }
}

void Node::restart(const Now& now) {
  bus_.log().set_time(now.sim);
  bus_.log().info("restarted", "reason=\"simulation time jumped back\"");
  bus_.forget_flows();
  on_restart(now);
  known_due_.reset();
}

void Node::count_refused_clocks(std::int64_t count) {
  bus_.counters().refused += count;
  bus_.counters().duplicate_publishers += count;
}

void Node::stop(const Now& now) {
  bus_.log().set_time(now.sim);
  bus_.rethrow_if_failed();
  commit(now, [&] {
    on_stop(now);
    publish_status(now, "stopped; " + status_text());
  });
}

bool Node::repair_after_stop(const Now& now, bool announces) {
  bus_.rethrow_if_failed();
  if (announces) bus_.announce_flows();
  bus_.repair(now.sim, now.steady, !is_behind_);
  const std::int64_t requested = bus_.flow_repair() != nullptr ? bus_.flow_repair()->num_requested() : 0;
  return requested > std::exchange(requests_seen_, requested);
}

void Node::publish_status(const Now& now, const std::string& text) {
  node_status_t status{};
  const BusCounters& counters = bus_.counters();
  status.utime = now.sim.to_utime();
  status.session = bus_.identity().session;
  status.sequence = status_sequence_++;
  status.node_name = name();
  status.node_version = kVersion;
  status.messages_received = counters.received;
  status.messages_sent = counters.sent;
  status.messages_refused = counters.refused;
  status.messages_unsent = counters.unsent;
  status.duplicate_publishers = counters.duplicate_publishers;
  status.gaps = counters.gaps;
  status.repaired = counters.repaired;
  status.lost = counters.lost;
  status.duplicates = counters.duplicates;
  status.late = counters.late;
  const Lateness lateness = bus_.lateness().summary(now.steady);
  status.lateness_p50_s = lateness.p50_s;
  status.lateness_p99_s = lateness.p99_s;
  status.lateness_max_s = lateness.max_s;
  status.lateness_limit_s = bus_.lateness().limit().seconds();
  status.status_text = text;
  bus_.publish(channels::kStatus.of(name()), status);
  report_lateness(now, lateness);
}

void Node::report_lateness(const Now& now, const Lateness& lateness) {
  const double limit_s = bus_.lateness().limit().seconds();
  if (limit_s == 0 || lateness.max_s <= limit_s || now.steady < next_lateness_report_) return;
  next_lateness_report_ = now.steady + kLatenessReported;
  bus_.log().warning("real-time-not-kept",
                     "p50_s=" + std::to_string(lateness.p50_s) + " p99_s=" + std::to_string(lateness.p99_s) +
                         " max_s=" + std::to_string(lateness.max_s) + " limit_s=" + std::to_string(limit_s) +
                         " late=" + std::to_string(bus_.counters().late));
}

}  // namespace halocline::bus
