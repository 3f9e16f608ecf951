#include "clients/halocline/analysis/outcome_summary.h"

#include <numeric>
#include <type_traits>

#include "bus/channels.h"
#include "bus/logs/channel_types.h"
#include "core/check.h"

namespace halocline::clients {

OutcomeSummary::OutcomeSummary(std::int64_t window_us) : window_us_(window_us) {
  require(window_us > 0, "the window must be above 0");
}

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
  const auto number = static_cast<std::size_t>(static_cast<std::uint8_t>(outcome.outcome));
  const std::int64_t departure = outcome.departure_utime;
  const std::int64_t into_window = ((departure % window_us_) + window_us_) % window_us_;
  ++total_.at(number);
  ++by_propagation_.at(static_cast<std::size_t>(static_cast<std::uint8_t>(outcome.propagation_used)));
  ++by_pair_[{outcome.source_id, outcome.receiver_id}].at(number);
  ++by_window_[departure - into_window].at(number);
  outcomes_.push_back(outcome);
}

std::string OutcomeSummary::name(std::int32_t vehicle_id) const {
  const auto found = names_.find(vehicle_id);
  return found != names_.end() ? found->second : std::to_string(vehicle_id);
}

const char* propagation_name(std::size_t propagation) {
  constexpr std::array<const char*, kPropagations> kNames{"straight", "rays", "straight without bottom"};
  return propagation < kPropagations ? kNames[propagation] : "?";
}

OutcomeSummary summary_of(LogReader& log, std::int64_t window_us) {
  OutcomeSummary summary(window_us);
  for (LoggedEvent event; log.next(event);) summary.count(event);
  return summary;
}

}  // namespace halocline::clients
