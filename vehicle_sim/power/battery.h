// SPDX-License-Identifier: BSD-3-Clause
// The battery of a vehicle: what is left in it, and what it was spent on.
//
// Model: energy_left = capacity - (hotel + shaft + transmit + receive), joules, since the start. All that is
// always on takes constant power; the shafts take theirs over each physics step, that at its beginning (first
// order in the step); what a packet takes counts as a whole, at the instant the channel server states and
// kEnergyLag later here: longer than a message takes, so that the sum does not depend on when it came.
// Packets are added in the order of their instants, causes and amounts. When nothing is left, nothing more is
// spent on hotel and shaft; what is left then lies below 0 by what was under way at most. Left out: voltage,
// temperature, self-discharge, losses that grow with the current.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::vehicle_sim {

struct BatterySettings {
  double capacity_j = 0;        // 0 and up
  double hotel_w = 0;           // of all that is always on, 0 and up
  double shaft_efficiency = 1;  // power of the shafts over electric power, above 0, at most 1
};

// In the order of modem_energy_t.
enum class PacketEnergy : std::uint8_t { kTransmit, kReceive };

class Battery {
 public:
  static constexpr SimDuration kEnergyLag = SimDuration::from_milliseconds(100);

  // Throws InvalidArgument where a setting is impossible.
  explicit Battery(const BatterySettings& settings);

  // What a packet takes at `at`, 0 and up.
  void add_packet(SimTime at, PacketEnergy cause, double energy_j);
  // A step of `seconds` that ends at `end`, with `shaft_w` mechanical at its beginning, 0 and up.
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
  std::vector<Packet> waiting_;  // ascending
};

}  // namespace halocline::vehicle_sim
