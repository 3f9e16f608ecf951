// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/outcome_summary.h"

#include <type_traits>

#include "bus/logs/channel_types.h"
#include "bus/messages/channels.h"

namespace halocline::clients {

void OutcomeSummary::count(const LoggedEvent& event, std::int64_t zero_us) {
  with_type_of(event.channel, [&]<class Message>() {
    if constexpr (std::is_same_v<Message, packet_outcome_t> || std::is_same_v<Message, vehicle_state_t>) {
      Message message;
      if (!decode_checked(event.data, message)) return;
      if constexpr (std::is_same_v<Message, packet_outcome_t>) {
        message.utime -= zero_us;
        message.departure_utime -= zero_us;
        count(message);
      } else {
        names_.emplace(message.vehicle_id, event.channel.substr(bus::channels::kState.prefix.size()));
      }
    }
  });
}

void OutcomeSummary::count(const packet_outcome_t& outcome) {
  const Key key{outcome.source_id,    outcome.receiver_id,     outcome.destination_id,
                outcome.send_session, outcome.packet_sequence, outcome.departure_utime,
                outcome.packet_kind};
  if (!counted_.insert(key).second) {
    ++repeated_;
    return;
  }
  add(outcome);
  outcomes_.push_back(outcome);
}

std::string OutcomeSummary::name(std::int32_t vehicle_id) const {
  if (vehicle_id == 0) return "several";
  const auto found = names_.find(vehicle_id);
  return found != names_.end() ? found->second : std::to_string(vehicle_id);
}

OutcomeSummary summary_of(LogReader& log, std::int64_t window_us) {
  OutcomeSummary summary(window_us);
  for (LoggedEvent event; log.next(event);) summary.count(event);
  return summary;
}

}  // namespace halocline::clients
