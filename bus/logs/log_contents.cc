// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_contents.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <type_traits>
#include <utility>

#include "bus/logs/channel_types.h"
#include "bus/logs/foreign_message.h"
#include "bus/messages/channel_family.h"
#include "bus/messages/message_codec.h"
#include "bus/messages/sequence_number.h"
#include "core/names.h"

namespace halocline::clients {
namespace {

constexpr double kNanosecondsPerMicrosecond = 1000, kTolerance = 0.1;
constexpr std::int64_t kShortest_us = 100'000;  // time span from which a unit can be told
constexpr std::size_t kMaxNamed = 10;

template <class Message>
concept HasUtime = requires(const Message& message) {
  message.utime;
};

std::string_view name_of(std::string_view channel) { return channel; }
std::string_view name_of(const bus::Family& family) { return family.prefix; }

// True if the part of the channel before its dot is that of a message type of Halocline.
bool is_of_a_family(std::string_view channel) {
  return bus::any_channel([&]<class Message>(const auto& ours) {
    return family_of(name_of(ours)) == family_of(without_repair(channel));
  });
}

bool is_about_thousandfold(double a, double b) {
  return b != 0 && std::abs(a / b / kNanosecondsPerMicrosecond - 1) <= kTolerance;
}

std::string events_text(std::int64_t count) {
  return std::to_string(count) + (count == 1 ? " event" : " events");
}

// Returns text such as "STATE.a (600 events), STATE.b (600 events)".
std::string list_of(const std::vector<std::pair<std::string, std::int64_t>>& channels) {
  std::string text;
  for (std::size_t i = 0; i < std::min(channels.size(), kMaxNamed); ++i)
    text +=
        (i == 0 ? "" : ", ") + printable(channels[i].first) + " (" + events_text(channels[i].second) + ")";
  if (channels.size() > kMaxNamed) text += " and " + std::to_string(channels.size() - kMaxNamed) + " more";
  return text;
}

}  // namespace

template <class Message>
void LogContents::read(Channel& channel, const Event& event) {
  if (event.data.size() >= sizeof(std::int64_t) && bus::int64_at(event.data, 0) != Message::getHash()) {
    ++channel.other_version;
    return;
  }
  Message message{};
  const std::string problem = decode_foreign(event.data, message).problem;
  if (!problem.empty()) return note_invalid(channel, event, problem);
  if constexpr (HasUtime<Message>) note_time(channel, event.stamp_us, message.utime);
  if constexpr (requires { packets_.take(event.channel, message); }) {
    const std::string_view name = without_repair(event.channel);
    packets_.take(name.substr(std::min(name.size(), name.find('.') + 1)), message);
  }
}

LogContents::Channel& LogContents::channel_of(std::string_view name) {
  const auto found = channels_.find(name);
  if (found != channels_.end()) return found->second;
  Channel channel;
  const bool is_ours =
      with_type_of(name, [&]<class Message>() { channel.read = &LogContents::read<Message>; });
  channel.is_misnamed = !is_ours && is_of_a_family(name);
  return channels_.emplace(std::string(name), std::move(channel)).first->second;
}

void LogContents::count(const Event& event) {
  Channel& channel = channel_of(event.channel);
  ++channel.events;
  if (channel.read != nullptr) (this->*channel.read)(channel, event);
}

void LogContents::note_invalid(Channel& channel, const Event& event, const std::string& problem) {
  if (channel.invalid++ > 0) return;
  channel.first_problem = problem;
  channel.first_file = event.file;
  channel.first_offset = event.offset;
  const bool has_time =
      problem.starts_with("utime ") && event.data.size() >= bus::kUtimeAt + sizeof(std::int64_t);
  if (has_time && std::llabs(bus::int64_at(event.data, bus::kUtimeAt)) > INT64_MAX / 1000)
    channel.first_problem += " (nanoseconds in the place of microseconds?)";
}

void LogContents::note_time(Channel& channel, std::int64_t stamp_us, std::int64_t utime) {
  if (utime == 0) return;
  if (channel.timed++ == 0) {
    channel.first_stamp_us = stamp_us;
    channel.first_utime = utime;
  }
  channel.last_stamp_us = stamp_us;
  channel.last_utime = utime;
}

std::vector<LogContents::Counted> LogContents::channels(
    const std::function<std::int64_t(const Channel&)>& count) const {
  std::vector<Counted> all;
  for (const auto& [name, channel] : channels_) {
    if (const std::int64_t events = count(channel); events > 0) all.emplace_back(name, events);
  }
  std::sort(all.begin(), all.end());
  return all;
}

void LogContents::add_unread(std::vector<std::string>& problems) const {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  const PacketAccount::Missing missing = packets_.missing();
  if (missing.without_outcome > 0)
    add(std::to_string(missing.without_outcome) + (missing.without_outcome == 1
                                                       ? " accepted packet has no outcome"
                                                       : " accepted packets have no outcome"));
  if (missing.lack_some > 0)
    add(std::to_string(missing.outcomes_lacking) + " outcomes are not there of " +
        std::to_string(missing.lack_some) + " accepted packets that have others");
  const auto other = channels([](const Channel& c) { return c.other_version; });
  for (std::size_t i = 0; i < std::min(other.size(), kMaxNamed); ++i)
    add(events_text(other[i].second) + " on " + other[i].first +
        (other[i].second == 1 ? " is of another version" : " are of another version"));
  if (other.size() > kMaxNamed)
    add("and so are events on " + std::to_string(other.size() - kMaxNamed) + " more channels");
  if (!text.empty()) problems.push_back(std::move(text));
}

void LogContents::add_invalid(const std::vector<std::string>& files,
                              std::vector<std::string>& problems) const {
  const auto invalid = channels([](const Channel& c) { return c.invalid; });
  for (std::size_t i = 0; i < std::min(invalid.size(), kMaxNamed); ++i) {
    const Channel& channel = channels_.find(invalid[i].first)->second;
    problems.push_back(events_text(invalid[i].second) + " on " + invalid[i].first +
                       " cannot be read, the first at " + files.at(channel.first_file) + ", byte " +
                       std::to_string(channel.first_offset) + ": " + channel.first_problem);
  }
  if (invalid.size() > kMaxNamed)
    problems.push_back("nor can events on " + std::to_string(invalid.size() - kMaxNamed) + " more channels");
}

void LogContents::add_clocks(std::vector<std::string>& problems) const {
  const auto thousandfold = [&](bool of_stamps) {
    return channels([&](const Channel& c) {
      const auto stamps = static_cast<double>(c.last_stamp_us - c.first_stamp_us),
                 times = static_cast<double>(c.last_utime - c.first_utime);
      if (std::min(std::abs(stamps), std::abs(times)) < kShortest_us) return std::int64_t{0};
      const auto last_stamp = static_cast<double>(c.last_stamp_us),
                 last_time = static_cast<double>(c.last_utime);
      const bool is_so =
          of_stamps ? is_about_thousandfold(stamps, times) && is_about_thousandfold(last_stamp, last_time)
                    : is_about_thousandfold(times, stamps) && is_about_thousandfold(last_time, last_stamp);
      return is_so ? c.timed : 0;
    });
  };
  const auto stamped = thousandfold(true), timed = thousandfold(false);
  if (!stamped.empty())
    problems.push_back("events are stamped in nanoseconds, where logs have microseconds: on " +
                       list_of(stamped));
  if (!timed.empty())
    problems.push_back("messages have their utime in nanoseconds, where it is microseconds: on " +
                       list_of(timed));
}

void LogContents::add_channels(std::vector<std::string>& problems) const {
  const auto misnamed = channels([](const Channel& c) { return c.is_misnamed ? c.events : 0; });
  if (!misnamed.empty())
    problems.push_back(
        "channels that are not ours, though they begin so, were left out; a vehicle's name is " +
        std::string(kNameRule) + ": " + list_of(misnamed));
  const auto all = channels([](const Channel& c) { return c.events; });
  const bool has_ours = std::any_of(channels_.begin(), channels_.end(),
                                    [](const auto& entry) { return entry.second.read != nullptr; });
  if (!all.empty() && !has_ours)
    problems.push_back("no event is on a channel of Halocline's: " + list_of(all));
}

std::vector<std::string> LogContents::problems(const std::vector<std::string>& files) const {
  std::vector<std::string> problems;
  add_unread(problems);
  add_invalid(files, problems);
  add_clocks(problems);
  add_channels(problems);
  return problems;
}

}  // namespace halocline::clients
