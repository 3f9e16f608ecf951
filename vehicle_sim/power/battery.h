// SPDX-License-Identifier: BSD-3-Clause
// Battery of a vehicle: the energy left, and its consumption by cause.
//
// Model, in joules since the start:
//
//   energy left = capacity - (hotel + shaft + transmit + receive)
//
// The hotel load, of all that is always on, has constant power. The shafts take over each physics step the
// power at its beginning (first order in the step). The energy of a packet counts as a whole at the instant
// that the channel server states plus kEnergyLag: longer than a message takes, so that the sum does not
// depend on when the message arrived. Packets are added in the order of instant, cause and amount. When no
// energy is left, hotel and shaft take no more; the energy left is then below 0 by at most the packets under
// way. Left out: voltage, temperature, self-discharge, losses that grow with the current.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::vehicle_sim {

struct BatterySettings {
  double capacity_j = 0;        // 0 or above
  double hotel_w = 0;           // hotel load, 0 or above
  double shaft_efficiency = 1;  // shaft power / electric power, above 0, at most 1
};

// The order is that of the constants in modem_energy_t.
enum class PacketEnergy : std::uint8_t { kTransmit, kReceive };

class Battery {
 public:
  static constexpr SimDuration kEnergyLag = SimDuration::from_milliseconds(100);

  // Throws InvalidArgument when a setting is out of its range.
  explicit Battery(const BatterySettings& settings);

  // Adds the energy that a packet takes at `at`, 0 or above.
  void add_packet(SimTime at, PacketEnergy cause, double energy_j);
  // Advances by a step of `seconds` that ends at `end`. `shaft_w`: mechanical power at its beginning, 0 or
  // above.
  void spend(SimTime end, double seconds, double shaft_w);

  double capacity_j() const { return settings_.capacity_j; }
  double left_j() const { return settings_.capacity_j - (hotel_j_ + shaft_j_ + transmit_j_ + receive_j_); }
  bool is_empty() const { return left_j() <= 0; }
  double hotel_j() const { return hotel_j_; }
  double shaft_j() const { return shaft_j_; }
  double transmit_j() const { return transmit_j_; }
  double receive_j() const { return receive_j_; }

  void archive(Archive& a) { a(hotel_j_, shaft_j_, transmit_j_, receive_j_, waiting_); }

 private:
  struct Packet {
    SimTime at;
    PacketEnergy cause = PacketEnergy::kTransmit;
    double energy_j = 0;
    auto operator<=>(const Packet&) const = default;
    void archive(Archive& a) { a(at, cause, energy_j); }
  };
  BatterySettings settings_;
  double hotel_j_ = 0, shaft_j_ = 0, transmit_j_ = 0, receive_j_ = 0;
  std::vector<Packet> waiting_;  // in ascending order
};

}  // namespace halocline::vehicle_sim
