#include "channel_server/vehicles/modem_schedule.h"

#include <iterator>

namespace halocline::channel_server {

void ModemSchedule::announce(SimTime from, const VehicleModem& modem) {
  if (at(from) == modem) return;
  announced_.insert_or_assign(from, modem);
  if (announced_.size() > kMaxAnnouncements) announced_.erase(announced_.begin());
}

const VehicleModem& ModemSchedule::at(SimTime instant) const {
  const auto later = announced_.upper_bound(instant);
  return later == announced_.begin() ? configured_ : std::prev(later)->second;
}

void ModemSchedule::forget_before(SimTime time) {
  while (announced_.size() > 1 && std::next(announced_.begin())->first < time) {
    announced_.erase(announced_.begin());
  }
}

}  // namespace halocline::channel_server
