#include "clients/halocline/replay_node.h"

#include <algorithm>

#include "clients/halocline/channel_types.h"

namespace halocline::clients {
namespace {

template <class Message>
inline constexpr bool kIsPlayed =
    std::is_same_v<Message, vehicle_state_t> || std::is_same_v<Message, modem_send_t> ||
    std::is_same_v<Message, modem_config_t> || std::is_same_v<Message, environment_change_t>;

// Collects what a log holds, with both candidate times of each event.
struct Collector {
  struct Timed {
    SimTime by_stamp;
    Recording::Event event;  // at: by utime
  };
  std::vector<Timed> events;
  std::int64_t clocks = 0, clocks_at_stamp = 0, ignored = 0;
  SimTime last_stamp, last_utime;

  template <class Message>
  void take(const LoggedEvent& logged, const Message& message) {
    const SimTime at = SimTime::from_utime(message.utime);
    if constexpr (kIsPlayed<Message>) {
      events.push_back({SimTime::from_utime(logged.stamp_us), {at, logged.channel, message}});
    } else {
      ++ignored;
    }
    if constexpr (std::is_same_v<Message, sim_clock_t>) {
      ++clocks;
      clocks_at_stamp += message.utime == logged.stamp_us ? 1 : 0;
    }
    if constexpr (std::is_same_v<Message, sim_clock_t> || std::is_same_v<Message, vehicle_state_t>) {
      last_utime = std::max(last_utime, at);
    }
  }

  void read(LogReader& log) {
    LoggedEvent logged;
    while (log.next(logged)) {
      last_stamp = std::max(last_stamp, SimTime::from_utime(logged.stamp_us));
      const bool ours = with_type_of(logged.channel, [&]<class Message>() {
        Message message;
        if (decode_checked(logged.data, message)) return take(logged, message);
        ++ignored;
      });
      if (!ours) ++ignored;
    }
  }
};

}  // namespace

Recording read_recording(LogReader& log) {
  Collector collector;
  collector.read(log);
  Recording recording;
  recording.ignored = collector.ignored;
  recording.stamped_with_simulation_time =
      collector.clocks > 0 && collector.clocks_at_stamp == collector.clocks;
  recording.end = recording.stamped_with_simulation_time ? collector.last_stamp : collector.last_utime;
  for (auto& [by_stamp, event] : collector.events) {
    if (recording.stamped_with_simulation_time) event.at = by_stamp;
    recording.events.push_back(std::move(event));
  }
  std::stable_sort(recording.events.begin(), recording.events.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  return recording;
}

ReplayNode::ReplayNode(lcm::LCM& lcm, bus::NodeIdentity identity, Recording recording)
    : Node(lcm, std::move(identity)), recording_(std::move(recording)) {}

bus::Due ReplayNode::on_due() const {
  const bool done = next_ == recording_.events.size();
  return {.sim = done ? SimTime::never() : recording_.events[next_].at};
}

void ReplayNode::on_step(const bus::Now& now) {
  for (; next_ < recording_.events.size() && recording_.events[next_].at <= now.sim; ++next_) {
    const Recording::Event& event = recording_.events[next_];
    std::visit([&](const auto& message) { bus().publish(event.channel, message); }, event.message);
  }
}

std::string ReplayNode::status_text() const {
  return "played " + std::to_string(next_) + " of " + std::to_string(recording_.events.size()) +
         " recorded messages";
}

}  // namespace halocline::clients
