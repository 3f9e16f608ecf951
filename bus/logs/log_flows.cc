// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_flows.h"

#include <algorithm>
#include <optional>
#include <ostream>

#include "bus/messages/channels.h"
#include "bus/messages/sequence_number.h"
#include "bus/repair/flow_watch.h"
#include "bus/repair/session_watch.h"

namespace halocline::clients {
namespace {

constexpr std::size_t kMaxMissingOfFlow = 10'000;  // limit for one flow; older ones are only counted

// Channels on which several sessions are unusual; elsewhere they are normal (shards, clients).
bool has_one_publisher(std::string_view channel) {
  const auto is_of = [&](const bus::Family& family) { return channel.starts_with(family.prefix); };
  const auto& held = bus::SessionWatch::kHeld;
  return is_of(bus::channels::kStatus) || std::any_of(held.begin(), held.end(), is_of);
}

}  // namespace

void LogFlows::Flow::note_missing(std::int64_t from, std::int64_t end) {
  if (from >= end) return;
  std::int64_t count = 0;
  if (__builtin_sub_overflow(end, from, &count)) count = INT64_MAX;
  const auto kept = std::min(count, static_cast<std::int64_t>(kMaxMissingOfFlow));
  expired = bus::saturating_sum(expired, count - kept);
  for (std::int64_t sequence = end - kept; sequence < end; ++sequence) missing.insert(sequence);
  for (; missing.size() > kMaxMissingOfFlow; missing.erase(missing.begin())) ++expired;
}

void LogFlows::Flow::take(std::int64_t sequence) {
  if (sequence > last) {
    note_missing(last + 1, sequence);
    last = sequence;
  } else if (sequence < first) {
    note_missing(sequence + 1, first);
    first = sequence;
  } else {
    missing.erase(sequence);
  }
}

LogFlows::Channel& LogFlows::channel_of(std::string_view name) {
  auto found = channels_.find(name);
  if (found == channels_.end()) {
    const bus::FlowType type = bus::flow_type_of(name);  // a SEND is numbered as its sender chooses
    found =
        channels_.emplace(std::string(name), Channel{.type = type.is_packet_to_send ? bus::FlowType() : type})
            .first;
  }
  return found->second;
}

void LogFlows::count(std::string_view channel, std::span<const std::uint8_t> data) {
  constexpr std::int64_t kSameRun_us = 10'000'000;
  const std::string_view repair = bus::channels::kRepair.prefix;
  while (channel.starts_with(repair)) channel.remove_prefix(repair.size());
  Channel& counted = channel_of(channel);
  const std::optional<bus::FlowHead> head = bus::flow_head(counted.type, data);
  if (!head) return;
  const std::int64_t utime = head->utime, session = head->session, sequence = head->sequence;
  ++counted.messages;
  const auto [found, is_new] = counted.flows.try_emplace(session, Flow{sequence, sequence, utime, {}, 0});
  Flow& flow = found->second;
  if (is_new) return;
  if (sequence < flow.last && utime / 2 < flow.last_utime / 2 - kSameRun_us / 2 &&
      !flow.missing.contains(sequence)) {
    begins_anew_ = true;
    const std::int64_t before =
        bus::saturating_sum(flow.expired, static_cast<std::int64_t>(flow.missing.size()));
    flow = {sequence, sequence, utime, {}, before};
    return;
  }
  flow.take(sequence);
  flow.last_utime = std::max(flow.last_utime, utime);
}

std::int64_t LogFlows::missing_of(const Channel& channel) {
  std::int64_t missing = 0;
  for (const auto& [session, flow] : channel.flows) {
    missing = bus::saturating_sum(missing, flow.expired);
    missing = bus::saturating_sum(missing, static_cast<std::int64_t>(flow.missing.size()));
  }
  return missing;
}

std::vector<LogFlows::OfChannel> LogFlows::remarkable() const {
  std::vector<OfChannel> all;
  for (const auto& [name, channel] : channels_) {
    const OfChannel one{name, channel.messages, missing_of(channel),
                        has_one_publisher(name) ? channel.flows.size() : 1};
    if (one.missing > 0 || one.sessions > 1) all.push_back(one);
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.channel < b.channel; });
  return all;
}

std::int64_t LogFlows::missing() const {
  std::int64_t missing = 0;
  for (const auto& [name, channel] : channels_) missing = bus::saturating_sum(missing, missing_of(channel));
  return missing;
}

void report_flows(std::ostream& out, const LogFlows& flows) {
  constexpr std::size_t kMaxChannelsNamed = 10;
  const auto all = flows.remarkable();
  const auto list = [&](const char* title, auto is_meant, auto print) {
    std::size_t named = 0;
    for (const auto& one : all) {
      if (!is_meant(one) || named++ >= kMaxChannelsNamed) continue;
      out << (named == 1 ? title : ", ") << one.channel << " ";
      print(one);
    }
    if (named > kMaxChannelsNamed) out << " and " << named - kMaxChannelsNamed << " more channels";
    if (named > 0) out << "\n";
  };
  list(
      "halocline: the log lacks messages, by their sequence numbers: ",
      [](const auto& one) { return one.missing > 0; },
      [&](const auto& one) {
        out << one.missing << " of " << bus::saturating_sum(one.messages, one.missing);
      });
  list(
      "halocline: programs were restarted, or runs joined; sessions: ",
      [](const auto& one) { return one.sessions > 1; }, [&](const auto& one) { out << one.sessions; });
  if (flows.begins_anew()) out << "halocline: the log holds several runs of the same sessions\n";
}

}  // namespace halocline::clients
