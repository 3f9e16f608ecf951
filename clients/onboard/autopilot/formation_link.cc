// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/formation_link.h"

#include <algorithm>
#include <utility>

#include "bus/config/scenario.h"
#include "clients/onboard/autopilot/autopilot_messages.h"
#include "core/names.h"

namespace halocline::clients {
namespace {

// Returns the first instant of start + k period that is not before `time`.
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
                             std::map<std::int32_t, std::string> leaders, Listener listener,
                             const VehicleTime& clocks)
    : broadcast_(pilot.broadcast),
      leaders_(std::move(leaders)),
      listener_(std::move(listener)),
      modem_(bus, address_of(bus, pilot)),
      clocks_(clocks),
      next_report_(next_report_at(broadcast_, clocks.shown(own_id(), SimTime()))) {
  modem_.on_receive([this](const modem_receive_t& packet) { take(packet); });
}

void FormationLink::take(const modem_receive_t& packet) const {
  const auto leader = leaders_.find(packet.source_id);
  if (leader == leaders_.end()) return;
  const SimTime at = SimTime::from_utime(packet.utime);
  auto report = decode_report(packet.payload, clocks_.shown(own_id(), at).seconds());
  if (!report) return;
  report->time_s -= clock_error_s(at.seconds());
  listener_(leader->second, *report);
}

double FormationLink::clock_error_s(double time_s) const {
  const SimTime at = SimTime::from_seconds(time_s);
  return clocks_.has_clock(own_id()) ? (clocks_.shown(own_id(), at) - at).seconds() : 0;
}

void FormationLink::step(const bus::Now& now, const std::optional<Situation>& situation) {
  const SimTime own = clocks_.shown(own_id(), now.sim);
  if (own >= next_report_) {
    const SimTime after = next_report_at(broadcast_, own + SimDuration::from_nanoseconds(1));
    const SimTime latest = clocks_.instant_of(own_id(), after - broadcast_.period, now.sim);
    if (situation) send(now.steady, latest, to_report(*situation));
    next_report_ = after;
  }
  modem_.resend(now.steady);
}

void FormationLink::send(SimTime steady, SimTime at, LeaderReport report) {
  report.time_s = std::max(report.time_s + clock_error_s(report.time_s), 0.0);
  modem_.send(steady, at, kBroadcastId, encode_report(report));
}

void FormationLink::restart(SimTime now) {
  next_report_ = next_report_at(broadcast_, clocks_.shown(own_id(), now));
}

}  // namespace halocline::clients
