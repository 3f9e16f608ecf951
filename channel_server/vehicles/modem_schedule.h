// Which modem a vehicle carries at an instant: the one configured, until it announces another.
//
// Announcements hold from the instant they name, whatever their order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "acoustics/modem/modem.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// What a modem does on a request to send while it is sending.
enum class WhenBusy {
  kRefuse,  // the transmission is refused
  kQueue,   // it starts when those before it have ended
};

// The profile whose packets may be of any form.
inline const std::string kGenericProfile = "generic";

struct VehicleModem {
  acoustics::Modem modem;
  std::int32_t max_payload_bytes = 4096;  // of one packet, 0..32 768; the modem's own limit holds as well
  WhenBusy when_busy = WhenBusy::kRefuse;
  std::string profile = kGenericProfile;  // where the numbers come from: a name, or the path of a file
  bool fitted = true;                     // false: the vehicle carries no modem at all
  bool operator==(const VehicleModem&) const = default;
};

// The largest payload of one packet that both limits allow.
inline std::size_t largest_payload_bytes(const VehicleModem& modem) {
  return std::min(static_cast<std::size_t>(modem.max_payload_bytes), max_payload_bytes(modem.modem));
}

class ModemSchedule {
 public:
  explicit ModemSchedule(VehicleModem configured) : configured_(std::move(configured)) {}

  // `modem` holds from `from` on, until an announcement of a later instant. A repetition of what holds
  // already changes nothing.
  void announce(SimTime from, const VehicleModem& modem);
  const VehicleModem& at(SimTime instant) const;
  // Calls visit(modem) for each that is carried at some instant of [from, to].
  template <class Visit>
  void visit_during(SimTime from, SimTime to, Visit&& visit) const {
    visit(at(from));
    for (auto next = announced_.upper_bound(from); next != announced_.end() && next->first <= to; ++next) {
      visit(next->second);
    }
  }
  // Drops announcements that were superseded before `time`.
  void forget_before(SimTime time);

 private:
  static constexpr std::size_t kMaxAnnouncements = 64;  // the earliest make room
  VehicleModem configured_;
  std::map<SimTime, VehicleModem> announced_;
};

}  // namespace halocline::channel_server
