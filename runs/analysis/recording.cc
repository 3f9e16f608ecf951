// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/recording.h"

#include <algorithm>
#include <map>
#include <optional>
#include <ostream>
#include <set>
#include <type_traits>

#include "bus/logs/channel_types.h"
#include "bus/logs/foreign_message.h"
#include "bus/messages/channels.h"
#include "runs/timeline/run_time_base.h"

namespace halocline::clients {
namespace {

constexpr std::int64_t kDay_us = 86'400'000'000;

template <class Message>
inline constexpr bool kIsPlayed =
    std::is_same_v<Message, vehicle_state_t> || std::is_same_v<Message, modem_send_t> ||
    std::is_same_v<Message, modem_config_t> || std::is_same_v<Message, modem_listen_t> ||
    std::is_same_v<Message, environment_change_t>;

template <class Message>
inline constexpr bool kIsEquipment =
    std::is_same_v<Message, vehicle_gps_t> || std::is_same_v<Message, vehicle_battery_t> ||
    std::is_same_v<Message, vehicle_sensors_t>;

// Returns the vehicle's name in a channel: "auv-1" for STATE.auv-1.
std::string vehicle_of(const std::string& channel) { return channel.substr(channel.find('.') + 1); }

struct Logged {
  std::size_t index;  // position among all events of the log
  Recording::Event event;
};

std::int64_t utime_of(const Recording::Event& event) {
  return std::visit([](const auto& message) { return message.utime; }, event.message);
}
void set_utime(Recording::Event& event, std::int64_t utime) {
  auto* listen = std::get_if<modem_listen_t>(&event.message);
  if (listen != nullptr && listen->wake_utime != 0) listen->wake_utime += utime - listen->utime;
  std::visit([&](auto& message) { message.utime = utime; }, event.message);
}

// Returns the vehicle's id in a message that has one; null for other messages.
std::int32_t* id_in(Recording::Event& event) {
  if (auto* state = std::get_if<vehicle_state_t>(&event.message)) return &state->vehicle_id;
  if (auto* send = std::get_if<modem_send_t>(&event.message)) return &send->source_id;
  return nullptr;
}

// Collects the messages of a log that are replayed.
struct Collector {
  Collector(Recording& into, Played played) : recording(into), what(played) {}
  Recording& recording;
  Played what;
  std::vector<Logged> logged;
  std::vector<std::int64_t> stamps;  // stamps of all events
  std::int64_t clocks = 0, clocks_at_stamp = 0, last_clock = 0;

  template <class Message>
  void take(const LoggedEvent& event) {
    Message message{};
    if constexpr (kIsPlayed<Message>) {
      const ForeignMessage decoded = decode_foreign(event.data, message);
      if (decoded.is_sound()) {
        recording.without_orientation += decoded.orientation_filled ? 1 : 0;
        logged.push_back({stamps.size() - 1, {SimTime(), event.channel, message}});
        return;
      }
    } else if (decode_checked(event.data, message)) {
      if constexpr (std::is_same_v<Message, packet_outcome_t>) ++recording.outcomes;
      if constexpr (std::is_same_v<Message, sim_clock_t>) {
        ++clocks;
        clocks_at_stamp += message.utime == event.stamp_us ? 1 : 0;
        last_clock = std::max(last_clock, message.utime);
      }
      if constexpr (kIsEquipment<Message>) {
        if (what == Played::kWithEquipment) {
          logged.push_back({stamps.size() - 1, {SimTime(), event.channel, message}});
          return;
        }
      }
    }
    ++recording.ignored;
  }

  void read(LogReader& log) {
    for (LoggedEvent event; log.next(event);) {
      stamps.push_back(event.stamp_us);
      if (!with_type_of(event.channel, [&]<class Message>() { take<Message>(event); })) ++recording.ignored;
    }
  }
};

// Returns the stamps with those replaced that break the order or are more than a day after the last valid
// one. The longest non-decreasing subsequence stays (patience sorting).
std::vector<std::int64_t> in_order(const std::vector<std::int64_t>& stamps) {
  // The element tails[n] is the last one of the best subsequence of n + 1.
  std::vector<std::size_t> tails, before(stamps.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const auto place =
        std::upper_bound(tails.begin(), tails.end(), stamps[i],
                         [&](std::int64_t stamp, std::size_t tail) { return stamp < stamps[tail]; });
    before[i] = place == tails.begin() ? i : *std::prev(place);
    if (place == tails.end()) {
      tails.push_back(i);
    } else {
      *place = i;
    }
  }
  std::vector<bool> stays(stamps.size(), false);
  for (std::size_t i = tails.empty() ? 0 : tails.back(), left = tails.size(); left > 0; --left, i = before[i])
    stays[i] = true;
  std::vector<std::int64_t> ordered(stamps.size());
  std::optional<std::int64_t> last;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (stays[i] && (!last || stamps[i] - *last <= kDay_us)) last = stamps[i];
    ordered[i] = last.value_or(0);
  }
  return ordered;
}

void go_by_stamps(const Collector& collected, Recording& recording) {
  const std::vector<std::int64_t> stamps = in_order(collected.stamps);
  for (const Logged& logged : collected.logged) {
    recording.events.push_back(logged.event);
    recording.events.back().at = SimTime::from_utime(stamps[logged.index]);
  }
  recording.end = SimTime::from_utime(stamps.empty() ? 0 : stamps.back());
}

std::optional<std::int64_t> middle_of_states(const std::vector<Logged>& logged) {
  std::vector<std::int64_t> times;
  for (const Logged& entry : logged) {
    if (std::holds_alternative<vehicle_state_t>(entry.event.message)) times.push_back(utime_of(entry.event));
  }
  return middle_of(std::move(times));
}

// Returns the utime of each message; a message without a valid one gets the latest that the log had reached.
std::vector<std::int64_t> sound_times(const Collector& collected, Recording& recording) {
  const auto middle = middle_of_states(collected.logged);
  const auto is_sound = [&](std::int64_t utime) { return middle && RunTimeBase{0, middle}.is_sound(utime); };
  std::vector<std::int64_t> times;
  std::optional<std::int64_t> reached;
  for (const Logged& entry : collected.logged) {  // messages before the first valid time get that time
    if (!reached && is_sound(utime_of(entry.event))) reached = utime_of(entry.event);
  }
  for (const Logged& entry : collected.logged) {
    const std::int64_t utime = utime_of(entry.event);
    const bool is_state = std::holds_alternative<vehicle_state_t>(entry.event.message);
    if (is_state && is_sound(utime)) reached = std::max(*reached, utime);
    if (!is_sound(utime)) ++recording.without_time;
    times.push_back(is_sound(utime) ? utime : reached.value_or(collected.stamps[entry.index]));
  }
  return times;
}

void go_by_messages(const Collector& collected, Recording& recording) {
  const std::vector<std::int64_t> times = sound_times(collected, recording);
  if (times.empty()) return;
  const std::int64_t first = *std::min_element(times.begin(), times.end());
  const std::int64_t zero = zero_of(first);
  recording.zero = SimDuration::from_microseconds(zero);
  for (std::size_t i = 0; i < times.size(); ++i) {
    recording.events.push_back(collected.logged[i].event);
    recording.events.back().at = SimTime::from_utime(times[i] - zero);
    set_utime(recording.events.back(), times[i] - zero);
    if (std::holds_alternative<vehicle_state_t>(recording.events.back().message))
      recording.end = std::max(recording.end, recording.events.back().at);
  }
  const bool clocks_agree = collected.last_clock - zero > 0 && collected.last_clock - zero <= kSameClock_us;
  if (clocks_agree) recording.end = std::max(recording.end, SimTime::from_utime(collected.last_clock - zero));
}

// Fills in ids of the messages that have none.
void fill_ids(const bus::Scenario& scenario, Recording& recording) {
  std::map<std::string, std::int32_t> ids;
  std::set<std::int32_t> taken;
  for (const bus::VehicleEntry& vehicle : scenario.vehicles) {
    ids.emplace(vehicle.name, vehicle.id);
    taken.insert(vehicle.id);
  }
  for (Recording::Event& event : recording.events) {
    const std::int32_t* id = id_in(event);
    if (id == nullptr || *id == 0) continue;
    if (std::holds_alternative<vehicle_state_t>(event.message))
      ids.insert_or_assign(vehicle_of(event.channel), *id);
    taken.insert(*id);
  }
  std::set<std::string> reported;
  for (Recording::Event& event : recording.events) {
    std::int32_t* id = id_in(event);
    if (id == nullptr || *id != 0) continue;
    const std::string vehicle = vehicle_of(event.channel);
    std::int32_t free = 1;
    while (taken.contains(free)) ++free;
    *id = ids.emplace(vehicle, free).first->second;
    taken.insert(*id);
    ++recording.without_id;
    if (reported.insert(vehicle).second) recording.ids_given.emplace_back(vehicle, *id);
  }
}

}  // namespace

Recording read_recording(LogReader& log, const bus::Scenario& scenario, Played what) {
  Recording recording;
  Collector collected(recording, what);
  collected.read(log);
  recording.stamped_with_simulation_time =
      is_stamped_with_simulation_time(collected.clocks, collected.clocks_at_stamp);
  if (recording.stamped_with_simulation_time) {
    go_by_stamps(collected, recording);
  } else {
    go_by_messages(collected, recording);
  }
  fill_ids(scenario, recording);
  std::stable_sort(recording.events.begin(), recording.events.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  return recording;
}

void print_repairs(std::ostream& out, const Recording& recording) {
  if (recording.zero > SimDuration())
    out << "times       moved: 0 is the recording's " << recording.zero.nanoseconds() / 1'000'000'000
        << " s\n";
  if (recording.without_time > 0)
    out << "times       " << recording.without_time
        << " messages are stamped by another clock or by none; played when they were logged\n";
  if (recording.without_id > 0) {
    out << "ids         " << recording.without_id << " messages have no vehicle id; given:";
    for (const auto& [vehicle, id] : recording.ids_given) out << " " << vehicle << "=" << id;
    out << "\n";
  }
  if (recording.without_orientation > 0)
    out << "pose        " << recording.without_orientation
        << " states have no orientation; taken as level, towards north\n";
}

}  // namespace halocline::clients
