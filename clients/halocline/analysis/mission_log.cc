#include "clients/halocline/analysis/mission_log.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

#include "bus/logs/channel_types.h"
#include "clients/mission/foreign_message.h"
#include "clients/mission/mission_time.h"

namespace halocline::clients {

MissionTime time_of(LogReader& log) {
  std::vector<std::int64_t> utimes;
  std::int64_t clocks = 0, clocks_at_stamp = 0;
  for (LoggedEvent event; log.next(event);) {
    with_type_of(event.channel, [&]<class Message>() {
      if constexpr (std::is_same_v<Message, vehicle_state_t> || std::is_same_v<Message, sim_clock_t>) {
        Message message{};
        if (!decode_foreign(event.data, message).is_sound) return;
        if constexpr (std::is_same_v<Message, vehicle_state_t>) {
          utimes.push_back(message.utime);
        } else {
          ++clocks;
          clocks_at_stamp += message.utime == event.stamp_us ? 1 : 0;
        }
      }
    });
  }
  MissionTime time;
  if (is_stamped_with_simulation_time(clocks, clocks_at_stamp) || utimes.empty()) return time;
  time.middle_us = middle_of(utimes);
  std::optional<std::int64_t> first;
  for (const std::int64_t utime : utimes) {
    if (time.is_sound(utime)) first = std::min(first.value_or(utime), utime);
  }
  time.zero_us = zero_of(first.value_or(0));
  return time;
}

MissionStore read_mission(const std::vector<std::string>& logs, MissionLimits limits) {
  LogReader times(logs), log(logs);
  MissionStore mission(time_of(times), limits);
  for (LoggedEvent event; log.next(event);) mission.add(event.stamp_us, event.channel, event.data);
  return mission;
}

}  // namespace halocline::clients
