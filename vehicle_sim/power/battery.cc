// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/power/battery.h"

#include <algorithm>
#include <limits>

#include "core/check.h"

namespace halocline::vehicle_sim {

Battery::Battery(const BatterySettings& settings) : settings_(settings) {
  constexpr double kMax = std::numeric_limits<double>::max();
  require_in_range(settings.capacity_j, 0, kMax, "capacity of a battery", "J");
  require_in_range(settings.hotel_w, 0, kMax, "hotel power", "W");
  require_in_range(settings.shaft_efficiency, 1e-3, 1, "efficiency of the shaft");
}

void Battery::add_packet(SimTime at, PacketEnergy cause, double energy_j) {
  const Packet packet{at, cause, energy_j};
  waiting_.insert(std::upper_bound(waiting_.begin(), waiting_.end(), packet), packet);
}

// Adds the energy of a step of duration dt: P_hotel dt and P_shaft / efficiency dt, and that of the packets
// that are due.
void Battery::spend(SimTime end, double seconds, double shaft_w) {
  const auto is_later = [&](const Packet& packet) { return packet.at + kEnergyLag > end; };
  const auto later = std::find_if(waiting_.begin(), waiting_.end(), is_later);
  for (auto packet = waiting_.begin(); packet != later; ++packet)
    (packet->cause == PacketEnergy::kTransmit ? transmit_j_ : receive_j_) += packet->energy_j;
  waiting_.erase(waiting_.begin(), later);
  if (is_empty()) return;
  hotel_j_ += settings_.hotel_w * seconds;
  shaft_j_ += shaft_w / settings_.shaft_efficiency * seconds;
}

}  // namespace halocline::vehicle_sim
