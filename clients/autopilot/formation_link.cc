// SPDX-License-Identifier: BSD-3-Clause
#include "clients/autopilot/formation_link.h"

#include <utility>

#include "bus/runtime/scenario.h"
#include "clients/autopilot/autopilot_messages.h"
#include "core/names.h"

namespace halocline::clients {
namespace {

// The first instant of start + k period that is not before `time`.
SimTime next_report_at(const Broadcast& broadcast, SimTime time) {
  if (broadcast.period <= SimDuration()) return SimTime::never();
  if (time <= broadcast.start) return broadcast.start;
  const std::int64_t period = broadcast.period.nanoseconds();
  const std::int64_t passed = ((time - broadcast.start).nanoseconds() + period - 1) / period;
  return broadcast.start + broadcast.period * passed;
}

ModemAddress address_of(const bus::Bus& bus, const PilotConfig& pilot) {
  const auto entropy = static_cast<std::uint64_t>(bus.identity().session);
  return {pilot.vehicle, pilot.vehicle_id, bus::session_of(entropy, pilot.vehicle)};
}

}  // namespace

FormationLink::FormationLink(bus::Bus& bus, const PilotConfig& pilot,
                             std::map<std::int32_t, std::string> leaders, Listener listener)
    : broadcast_(pilot.broadcast),
      leaders_(std::move(leaders)),
      listener_(std::move(listener)),
      modem_(bus, address_of(bus, pilot)),
      next_report_(next_report_at(broadcast_, SimTime())) {
  modem_.on_receive([this](const modem_receive_t& packet) { take(packet); });
}

void FormationLink::take(const modem_receive_t& packet) const {
  const auto leader = leaders_.find(packet.source_id);
  if (leader == leaders_.end()) return;
  const auto report = decode_report(packet.payload, SimTime::from_utime(packet.utime).seconds());
  if (report) listener_(leader->second, *report);
}

void FormationLink::step(const bus::Now& now, const std::optional<Situation>& situation) {
  if (now.sim >= next_report_) {
    const SimTime after = next_report_at(broadcast_, now.sim + SimDuration::from_nanoseconds(1));
    const SimTime latest = after - broadcast_.period;
    if (situation) modem_.send(now.steady, latest, kBroadcastId, encode_report(to_report(*situation)));
    next_report_ = after;
  }
  modem_.resend(now.steady);
}

void FormationLink::restart(SimTime now) { next_report_ = next_report_at(broadcast_, now); }

}  // namespace halocline::clients
